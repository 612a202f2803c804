// Runs of two result sets that compute the same.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "experiments/margins.h"
#include "experiments/result_set.h"

namespace textonbench {

struct RunPair {
  const Record* old_run = nullptr;
  const Record* new_run = nullptr;

  std::string text(const char* spec_key) const { return (*old_run)["spec"][spec_key].get<std::string>(); }
};

/// In order of computation. Pairs point into the sets.
std::vector<RunPair> pair_runs(const ResultSet& old_set, const ResultSet& new_set);

/// Why the sets share no run: the parts of a run that have no value in common.
std::string explain_no_pairs(const ResultSet& old_set, const ResultSet& new_set);

/// Two numbers to compare.
struct NumberPair {
  std::string exemplar, method;
  double old_value = 0, new_value = 0;
};

struct MetricPairs {
  std::vector<NumberPair> numbers;
  std::size_t lost = 0;  ///< NEW was asked for the metric and has no number where OLD has one
  std::string reason;    ///< why there is nothing to compare, when `numbers` is empty
};

/// The numbers of one metric that may be compared, see compare.h.
MetricPairs collect_pairs(const MetricEntry& metric, const std::vector<RunPair>& runs);

}  // namespace textonbench
