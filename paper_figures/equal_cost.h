// Which runs of an exemplar may stand side by side: those that cost about as much.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "paper_figures/report_runs.h"

namespace textonbench {

/// A run that may be compared, with its operations a pixel.
struct CostedRun {
  const ReportRun* entry = nullptr;
  double operations = 0;
};

/// Runs of one exemplar that are textures of the plane or a torus: ok, with a picture of a sample, its operations a
/// pixel, and an error against the exemplar's law (rme or smoothed_rme), drawn by the processor; of the size for
/// which there are the most methods, the largest such. In the order of the runs.
std::vector<CostedRun> costed_runs(const std::vector<ReportRun>& runs, const std::string& exemplar);

/// What a budget of operations a pixel buys.
struct CostLevel {
  double budget = 0;
  std::vector<CostedRun> runs;  ///< of each method the one nearest to the budget by ratio, within a factor of two
  struct Absent {
    std::string method;
    double nearest = 0;  ///< operations a pixel of its nearest run
  };
  std::vector<Absent> absent;  ///< methods without such a run
};

/// Of the budgets 10, 30, 100, … 100000 those that buy at least two methods. Of runs as near the first one counts.
std::vector<CostLevel> cost_levels(const std::vector<CostedRun>& runs);

/// The value of a metric of a run, if it was measured and is a number.
std::optional<double> value_of(const ReportRun& run, const std::string& metric);

}  // namespace textonbench
