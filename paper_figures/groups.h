// Runs that differ in exemplar and seed only belong to one group: a row of a table, a series of a chart.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "paper_figures/selection.h"

namespace textonbench {

/// A number made from one or several records.
struct Average {
  std::optional<double> value;
  std::optional<double> error{};   ///< standard error of `value`, from the records' own; none when one lacks it
  std::optional<double> spread{};  ///< standard deviation between exemplars; none for fewer than two
  std::optional<double> floor{};   ///< mean of the floors; none when a record lacks it
  std::size_t count = 0;           ///< how many numbers went in
};

struct RunGroup {
  std::string title;   ///< the label, with the options that tell it from other groups of that label
  std::string detail;  ///< "rpn, component = periodic, phase = added"
  std::vector<const SelectedRun*> runs;

  /// The runs on one exemplar, one for each seed.
  std::vector<const SelectedRun*> on(std::string_view exemplar) const;
};

/// Groups in order of first appearance. They point into `runs`. Runs that differ in the parameters `swept`, too, belong
/// to one group.
std::vector<RunGroup> group_runs(const std::vector<SelectedRun>& runs, const std::vector<std::string>& swept = {});

/// The metric of one record; no value when the run failed or the method has none.
Average metric_of(const SelectedRun& run, std::string_view metric);

/// Mean over seeds, v = Σ v_i / n with standard error sqrt(Σ e_i²) / n.
Average average_over_seeds(const std::vector<const SelectedRun*>& runs, std::string_view metric);

/// Mean over the group's exemplars of their means over seeds; `spread` is the deviation between exemplars and `count`
/// the number of exemplars that have a value.
Average average_over_exemplars(const RunGroup& group, std::string_view metric);

}  // namespace textonbench
