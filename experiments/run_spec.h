// One run: everything that decides its numbers, and nothing else.
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "experiments/exemplars.h"
#include "methods/base/params.h"
#include "methods/method.h"

namespace textonbench {

/// A model of one exemplar and what is measured on it. `samples` samples are drawn, with seeds derived from `seed`.
struct RunSpec {
  std::string method;
  std::map<std::string, ParamValue> params;             ///< complete: defaults included
  std::map<std::string, std::string> file_sha256 = {};  ///< of what an option names, by option (see hash_named)
  std::string exemplar;
  std::string exemplar_sha256;
  Extent size;  ///< of the samples; 0x0 means the exemplar's own size
  bool periodic = true;
  double step = 1;  ///< between pixels of a sample, in pixels of the exemplar
  /// How a graphics processor draws the samples (gpu_run.h), complete; empty where the method does, on the processor.
  std::map<std::string, ParamValue> gpu = {};
  std::uint64_t seed = 1;
  int samples = 1;
  std::vector<std::string> metrics;   ///< catalogue names, sorted
  std::vector<std::string> pictures;  ///< names of pictures to keep, sorted
  // Not part of the identity: what a run may take does not change what it computes.
  double timeout_seconds = 300;
  int memory_limit_mb = 0;  ///< 0: a share of the machine's memory
};

/// SHA-256 of what every option names whose unit is "file", "exemplar" or "mask" and that names something: two runs
/// with the same path and other content are not the same. Throws std::invalid_argument with the option for a file that
/// cannot be read or an exemplar that is not here.
std::map<std::string, std::string> hash_named(const MethodEntry& method,
                                              const std::map<std::string, ParamValue>& params,
                                              const ExemplarCatalog& catalog);

/// The exemplar that an option of unit "exemplar" names, if there is such an option and it is not empty.
std::optional<ExemplarInfo> second_exemplar(const MethodEntry& method, const std::map<std::string, ParamValue>& params,
                                            const ExemplarCatalog& catalog);

/// JSON with a fixed key order; the limits are left out, file_sha256 where no option names a file, and gpu where it is
/// empty.
nlohmann::ordered_json to_json(const RunSpec& spec);
/// Throws std::invalid_argument naming the key that is missing or wrong.
RunSpec run_spec_from_json(const nlohmann::ordered_json& json);

/// The method whose samples, of the exact Gaussian law of the exemplar, every floor is measured on.
inline constexpr const char* floor_method = "adsn";

/// 16 hexadecimal digits: SHA-256 of the sources that decide these metrics of a method (provenance.h): the method's own
/// file, those of the metrics, what executes them and measures their floors, what draws the procedural exemplars and,
/// of samples drawn on a graphics processor, the renderer with its shaders. Throws std::invalid_argument for an unknown
/// method or metric.
std::string code_version(const std::string& method, std::span<const std::string> metrics, bool on_gpu);
std::string code_version(const RunSpec& spec);

/// 16 hexadecimal digits: SHA-256 of to_json(spec) and of its code_version. Two runs with the same id compute the same.
/// The pictures to keep are part of it, because a record without them cannot stand for one with them; the label of its
/// table, the order of the plan, threads, jobs and limits are not.
std::string run_id(const RunSpec& spec);

/// Params, and the options under gpu as "gpu.path" and so on: what sets apart the runs of a method on an exemplar.
std::map<std::string, ParamValue> options_of(const RunSpec& spec);

/// The command that repeats the run by hand: "textonbench measure rpn mamurk_a_1 -p phase=added --seed 1 --samples 8
/// …".
std::string command_line(const RunSpec& spec);

}  // namespace textonbench
