// One [[runs]] table as a set of axes: how many runs it makes, and which.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/config.h"
#include "experiments/exemplars.h"
#include "experiments/run_spec.h"
#include "methods/method.h"

namespace textonbench {

/// An exemplar of the catalog with the hash of its file.
struct ChosenExemplar {
  const ExemplarInfo* info;
  std::string sha256;  ///< empty when the exemplar is not available
};

/// What a table's lists of names stand for.
struct SweepChoices {
  std::vector<const MethodEntry*> methods;
  std::vector<const ChosenExemplar*> exemplars;
  std::vector<std::string> metrics, pictures;
};

/// The conditions of one element of `exclude`; what is not set matches everything.
struct Exclusion {
  std::optional<std::string> method, exemplar;
  std::optional<std::uint64_t> seed;
  std::map<std::string, ParamValue> params;

  bool matches(const RunSpec& run) const;
};

class Sweep {
 public:
  /// Checks the parameters and exclusions of `table`, which must outlive the sweep like `catalog`, and the lengths of a
  /// zip. Throws ConfigError.
  Sweep(const RunsTable& table, SweepChoices choices, const ExemplarCatalog& catalog);

  /// Number of runs before `exclude`; the largest number there is when it does not fit.
  std::size_t count() const;

  /// Calls `take` for every run that is not excluded, seeds varying fastest. Throws ConfigError when none is left.
  void expand(const std::function<void(RunSpec, const ChosenExemplar&)>& take) const;

 private:
  void add_gpu_axes();
  ParamValue check_param(const MethodEntry& method, const std::string& name, const ParamValue& value,
                         const std::string& path, const std::string& element) const;
  Exclusion read_exclusion(std::size_t index) const;
  ParamValue read_exclusion_param(const std::string& name, const ParamValue& value, const std::string& path) const;
  void check_zip() const;
  void check_ablation() const;
  bool is_param(std::size_t axis) const;
  std::size_t ablation_count() const;
  /// Position on each axis of the run of that number.
  std::vector<std::size_t> zip_digits(std::size_t run) const;
  std::vector<std::size_t> grid_digits(std::size_t run) const;
  RunSpec make_spec(const std::vector<std::size_t>& digits) const;

  const RunsTable& table_;
  SweepChoices choices_;
  const ExemplarCatalog& catalog_;
  std::vector<std::pair<std::string, std::vector<ParamValue>>> params_;
  std::vector<std::pair<std::string, std::vector<ParamValue>>> gpu_;
  std::vector<Exclusion> exclusions_;
  std::vector<std::pair<std::string, std::size_t>> axes_;  ///< key and number of values, slowest first
};

/// Where `path` ("seeds[1]") stands in the config: its own place, else that of the list, else of the table.
SourcePlace place_of(const RunsTable& table, const std::string& path);

/// Calls `look_up`, giving the std::invalid_argument that it throws the place of `path`.
template <class LookUp>
auto at_place(const RunsTable& table, const std::string& path, const LookUp& look_up) {
  try {
    return look_up();
  } catch (const std::invalid_argument& error) {
    throw ConfigError(place_of(table, path), error.what());
  }
}

}  // namespace textonbench
