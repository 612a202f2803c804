// Config -> list of runs. Pure: reads no clock, makes no file.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "experiments/config.h"
#include "experiments/exemplars.h"
#include "experiments/run_spec.h"

namespace textonbench {

/// A run of the plan with the (first) `[[runs]]` table it came from.
struct PlannedRun {
  RunSpec spec;
  std::string id;
  std::string label;  ///< name of the [[runs]] table
};

/// An exemplar that a config names and this machine lacks: its runs are left out of the plan and told.
struct MissingExemplar {
  std::string name;
  std::string how_to_get;
  std::size_t runs;
};

struct Plan {
  std::vector<PlannedRun> runs;  ///< duplicates (same id) removed, in config order
  std::vector<MissingExemplar> missing;
  /// Indices into `runs` of what each [[runs]] table asks for: tables that overlap share runs.
  std::map<std::string, std::vector<std::size_t>> by_label;
};

/// Expands every [[runs]] table. Throws ConfigError (file:line:column) for an unknown method, parameter, metric or
/// exemplar, a value out of range, an empty sweep, or a table of more than `most_runs` runs (the count is told).
Plan make_plan(const Config& config, const ExemplarCatalog& exemplars, std::size_t most_runs = 20000);

}  // namespace textonbench
