// What earlier records say about a planned run: whether it is needed, why, and how long it may take.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/plan.h"
#include "experiments/record.h"

namespace textonbench {

class History {
 public:
  explicit History(const std::vector<Record>& records);

  /// Recorded with the status "ok" or "refused": running it again would compute the same. A failure is tried again.
  bool is_reusable(const std::string& id) const;

  /// Why a run that is not reusable would be made: its earlier failure with the reason; the code version that differs;
  /// or where its spec differs from the nearest one recorded for this method and exemplar, as "params.phase (added ->
  /// replaced)"; or that there is none.
  std::string why_run(const PlannedRun& run) const;

  /// Wall seconds of the run: pixels x samples times the median cost of one pixel of one sample in the successful
  /// records of its method. `exemplar_size` counts where the spec has no size. Nothing without such a record.
  std::optional<double> estimate_seconds(const RunSpec& spec, Extent exemplar_size) const;

  /// Size of an exemplar of which there is a record.
  std::optional<Extent> exemplar_size(const std::string& sha256) const;

 private:
  /// Keys of a spec, parameters as "params.NAME", with their values as JSON text; code_version beside them.
  using FlatSpec = std::map<std::string, std::string>;
  static FlatSpec flatten(const Record& spec, const std::string& code_version);

  struct Outcome {
    bool failed;
    std::string reason;
  };
  std::map<std::string, Outcome> by_id_;
  std::map<std::pair<std::string, std::string>, std::vector<FlatSpec>> specs_;  ///< by method and exemplar
  std::map<std::string, double> seconds_per_pixel_;                             ///< by method
  std::map<std::string, Extent> exemplar_sizes_;                                ///< by SHA-256
};

}  // namespace textonbench
