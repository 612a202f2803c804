// Which records a figure stands on.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/config.h"
#include "experiments/plan.h"
#include "experiments/record.h"

namespace textonbench {

/// A planned run with its latest record, when there is one. Points into the plan, which must outlive it.
struct SelectedRun {
  const PlannedRun* planned = nullptr;
  std::string label;  ///< of the [[runs]] table that the figure reads it for; another table may ask for it too
  std::optional<Record> record;

  const RunSpec& spec() const { return planned->spec; }
  /// "ok", "failed", "refused", or "missing" when there is no record.
  std::string status() const;
  bool ok() const { return status() == "ok"; }
  /// Why there is no result: "failed: timed out after 300 s". Empty for a run that is ok.
  std::string reason() const;
};

/// Runs of the figure's [[runs]] tables, in the order that the figure names those tables and, within one, in plan
/// order, each with its latest record.
std::vector<SelectedRun> select_runs(const FigureTable& figure, const Plan& plan, const std::vector<Record>& records);

/// Why no figure may be made from these runs: records that are missing (named), with the command that makes them.
/// Records of another version of the code have another id, so they count as missing. Nothing when they will do.
std::optional<std::string> unusable(const Config& config, const std::vector<SelectedRun>& runs);

/// "rpn on ring, seed 2 (id 0123456789abcdef)".
std::string describe(const SelectedRun& run);

/// What a figure may select a run by, as the text of its value: exemplar, seed, method, periodic, width, height, or an
/// option (options_of). Nothing where the run has no such option.
std::optional<std::string> attribute_of(const RunSpec& spec, const std::string& key);

/// Names of the exemplars of these runs, each once, in order.
std::vector<std::string> exemplars_of(const std::vector<SelectedRun>& runs);

/// The config's file as a command line names it: relative to the folder that holds configs/ where it lies there.
std::string config_argument(const Config& config);

}  // namespace textonbench
