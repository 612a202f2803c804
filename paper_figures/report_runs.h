// Every run that the report speaks of, once.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "paper_figures/picture_store.h"
#include "paper_figures/report.h"
#include "paper_figures/selection.h"

namespace textonbench {

/// A run with the config that asks for it first.
struct ReportRun {
  SelectedRun run;
  const Config* config = nullptr;

  /// "rpn on ring, seed 2".
  std::string title() const;
};

struct RunCounts {
  std::size_t planned = 0, recorded = 0, failed = 0, refused = 0, missing = 0;
};

/// In config and plan order; a run that several configs share appears under the first. Points into `configs`.
std::vector<ReportRun> report_runs(const std::vector<ReportConfig>& configs, const std::vector<Record>& records);
RunCounts count_runs(const std::vector<ReportRun>& runs);
/// "12 runs, 10 recorded, 1 failed, 1 not run yet".
std::string in_words(const RunCounts& counts);

/// Section with a foldable summary, command and JSON of every run.
std::string records_html(const std::vector<ReportRun>& runs, const PictureStore& pictures);

/// Section that lists failed, refused and missing runs, exemplars that are not here, and unusable lines of the records.
std::string problems_html(const std::vector<ReportRun>& runs, const std::vector<ReportConfig>& configs,
                          const std::vector<BadLine>& bad_lines);

}  // namespace textonbench
