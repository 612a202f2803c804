// Two result sets, metric by metric: better, same, worse, or not decided by the data.
//
// Runs are paired by what they compute (see result_set.h), whatever the code. A pair's change of a metric is
//
//   d = (new − old) / max((|new| + |old|) / 2, resolution)   or, for an absolute margin,   d = new − old;
//
// of metrics that should be near zero, |new| and |old| are compared. It is symmetric in old and new, so that noise
// alone favors neither. The estimate is the mean of d over exemplars of the means over the exemplar's runs, with the 95
// % two-level bootstrap-t interval of statistics/bootstrap.h. With a margin m (margins.h), verdicts are, in this order:
//
//   same          the interval lies inside (−m, m); or every d is zero
//   worse         the change is significant, and the interval lies wholly on the bad side of zero (of m, for times)
//   better        likewise on the good side
//   inconclusive  otherwise
//
// A change is significant when its p-value, Holm-corrected over all metrics (and over the methods of each, where there
// are several), is at most 5 %: the rate at which noise alone makes anything better, worse or changed, as far as the
// intervals cover what they should. Measured by compare_test on 13 exemplars x 4 seeds: 13 of 200 comparisons (6.5 %),
// of which 3 (1.5 %) told a regression. Counts that the same code repeats (bytes, operations) are compared as they are,
// without an interval. A metric that is neither good nor bad when large is "changed" where
// another would be better or worse.
//
// A metric is worse, too, when one of the methods is, and when NEW lost values: numbers that OLD has and that NEW was
// asked for. Runs that NEW failed or refused and OLD did not are regressions of their own.
//
// Times are compared only between runs of the same cpu, cores and threads, for exemplars with at least 9 timed
// repetitions of a method with its parameters in each set, and as ratios to the run's floor where both runs have one. A
// run counts as many repetitions as it has samples for the times of synthesis, and one for that of the analysis.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/result_set.h"
#include "experiments/statistics/bootstrap.h"

namespace textonbench {

enum class Verdict { better, same, worse, inconclusive, changed, not_compared };
std::string_view to_string(Verdict verdict);

struct MetricComparison {
  std::string metric;
  std::string method;  ///< empty: over all methods
  Verdict verdict = Verdict::not_compared;
  std::string reason{};  ///< why there is no comparison, or what else made it worse
  Estimate change{};     ///< mean of d; above zero when NEW is larger
  double margin = 0;
  bool relative = true;
  double p_value = 1;                 ///< Holm-corrected
  double sign_rank_p_value = 1;       ///< Wilcoxon over exemplars, not corrected; told besides
  double old_mean = 0, new_mean = 0;  ///< of the numbers compared
  std::size_t pairs = 0, exemplars = 0, larger = 0, smaller = 0;  ///< exemplars whose mean d is above or below zero
  std::vector<MetricComparison> methods{};                        ///< the same for each method, where there are several
};

struct Comparison {
  std::vector<MetricComparison> metrics;  ///< in catalogue order
  std::size_t pairs = 0, only_old = 0, only_new = 0;
  std::vector<std::string> newly_failed;  ///< "rpn on ring, seed 1: failed: timed out"

  /// Metrics that are worse, and runs that newly fail.
  std::size_t regressions() const;
};

struct CompareOptions {
  int replicates = 10000;  ///< raised, where many tests share the 5 %, to what their p-values need
  Seed seed{1};
};

/// Throws std::invalid_argument when the sets share no run, naming what differs.
Comparison compare(const ResultSet& old_set, const ResultSet& new_set, const CompareOptions& options = {});

/// A change of this metric as text: "+2.00 %", or "+0.031" where the margin is absolute.
std::string change_text(const MetricComparison& row, double change);

/// {"metrics": [{"name", "verdict", "estimate", "interval": [low, high], …}], "regressions": n, …}; an infinite bound
/// is null.
nlohmann::ordered_json to_json(const Comparison& comparison);

}  // namespace textonbench
