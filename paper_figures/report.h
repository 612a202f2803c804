// The HTML report: one file that shows what was measured, on what, how, and how to do it again.
#pragma once

#include <filesystem>
#include <vector>

#include "experiments/config.h"
#include "experiments/exemplars.h"
#include "experiments/plan.h"
#include "experiments/record.h"

namespace textonbench {

/// A config with the plan that was made from it.
struct ReportConfig {
  Config config;
  Plan plan;
};

/// Makes the figures of every config and writes report/index.html below the results folder. The page is self-contained
/// (styles, script, charts and pictures are inside) and depends on the records, configs, benchmarks.json and
/// baseline of the results folder only; it links to the ledger page where there is one, and to a page
/// for every exemplar of which methods can be compared (exemplar_pages.h), which are written beside it. Returns the
/// page's path. Throws what make_figures throws, and std::runtime_error when a template is missing or the page cannot
/// be written.
std::filesystem::path write_report(const std::vector<ReportConfig>& configs, const ExemplarCatalog& exemplars,
                                   const ResultsFolder& results);

}  // namespace textonbench
