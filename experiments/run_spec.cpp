#include "experiments/run_spec.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "experiments/metrics/metric.h"
#include "experiments/provenance.h"
#include "methods/base/masks.h"

namespace textonbench {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::string_view, 13> keys{"method",  "params",   "file_sha256", "exemplar", "exemplar_sha256",
                                                "size",    "periodic", "step",        "gpu",      "seed",
                                                "samples", "metrics",  "pictures"};

[[noreturn]] void refuse(std::string_view key, std::string_view expected, const Json& found) {
  throw std::invalid_argument(fmt::format("run spec: {}: expected {}, found {}", key, expected, found.dump()));
}

const Json& require(const Json& json, std::string_view key) {
  const auto found = json.find(key);
  if (found == json.end()) {
    throw std::invalid_argument(fmt::format("run spec lacks the key \"{}\"", key));
  }
  return *found;
}

std::string read_text(const Json& json, std::string_view key) {
  const Json& value = require(json, key);
  if (!value.is_string()) {
    refuse(key, "a string", value);
  }
  return value.get<std::string>();
}

std::uint64_t read_whole(const Json& value, std::string_view key, std::uint64_t min, std::uint64_t max) {
  const bool negative = value.is_number_integer() && !value.is_number_unsigned() && value.get<std::int64_t>() < 0;
  if (!value.is_number_integer() || negative || value.get<std::uint64_t>() < min || value.get<std::uint64_t>() > max) {
    refuse(key, fmt::format("a whole number from {} to {}", min, max), value);
  }
  return value.get<std::uint64_t>();
}

int read_int(const Json& value, std::string_view key, std::uint64_t min) {
  return static_cast<int>(read_whole(value, key, min, std::numeric_limits<int>::max()));
}

std::vector<std::string> read_names(const Json& json, std::string_view key) {
  const Json& value = require(json, key);
  std::vector<std::string> names;
  if (!value.is_array()) {
    refuse(key, "a list of strings", value);
  }
  for (const Json& name : value) {
    if (!name.is_string()) {
      refuse(key, "a list of strings", value);
    }
    names.push_back(name.get<std::string>());
  }
  return names;
}

ParamValue read_param(const std::string& path, const Json& value) {
  if (value.is_boolean()) {
    return value.get<bool>();
  }
  if (value.is_number_float()) {
    return value.get<double>();
  }
  if (value.is_number_integer()) {
    return value.get<std::int64_t>();
  }
  if (value.is_string()) {
    return value.get<std::string>();
  }
  refuse(path, "a string, a number, true or false", value);
}

std::map<std::string, ParamValue> read_options(const Json& json, const std::string& key) {
  const Json& options = require(json, key);
  if (!options.is_object()) {
    refuse(key, "an object", options);
  }
  std::map<std::string, ParamValue> values;
  for (const auto& [name, value] : options.items()) {
    values.emplace(name, read_param(fmt::format("{}.{}", key, name), value));
  }
  return values;
}

Json options_to_json(const std::map<std::string, ParamValue>& options) {
  Json json = Json::object();
  for (const auto& [name, value] : options) {
    std::visit([&, key = name](const auto& v) { json[key] = v; }, value);
  }
  return json;
}

/// One word for a POSIX shell.
std::string quote(const std::string& word) {
  constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_@%+=:,./-";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) {
    return word;
  }
  std::string quoted = "'";
  for (const char c : word) {
    quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  }
  return quoted + "'";
}

}  // namespace

std::optional<ExemplarInfo> second_exemplar(const MethodEntry& method, const std::map<std::string, ParamValue>& params,
                                            const ExemplarCatalog& catalog) {
  const auto option = std::ranges::find(method.params, "exemplar", &ParamSpec::unit);
  if (option == method.params.end()) return std::nullopt;
  const auto given = params.find(std::string(option->name));
  if (given == params.end()) return std::nullopt;
  const std::string& name = std::get<std::string>(given->second);
  return name.empty() ? std::nullopt : std::optional(find_exemplar(catalog, name));
}

std::map<std::string, std::string> hash_named(const MethodEntry& method,
                                              const std::map<std::string, ParamValue>& params,
                                              const ExemplarCatalog& catalog) {
  std::map<std::string, std::string> hashes;
  for (const ParamSpec& option : method.params) {
    const auto given = params.find(std::string(option.name));
    if (given == params.end()) continue;
    try {
      if (option.unit == "exemplar") {
        if (const auto second = second_exemplar(method, params, catalog)) {
          hashes.emplace(option.name, exemplar_sha256(*second));
        }
      } else if (option.unit == "file") {
        const std::string& file = std::get<std::string>(given->second);
        if (!file.empty()) hashes.emplace(option.name, sha256_of_file(file));
      } else if (option.unit == "mask") {
        if (const auto file = mask_file(std::get<std::string>(given->second))) {
          hashes.emplace(option.name, sha256_of_file(*file));
        }
      }
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("option {}: {}", option.name, error.what()));
    }
  }
  return hashes;
}

Json to_json(const RunSpec& spec) {
  Json json;
  json["method"] = spec.method;
  json["params"] = options_to_json(spec.params);
  if (!spec.file_sha256.empty()) json["file_sha256"] = spec.file_sha256;
  json["exemplar"] = spec.exemplar;
  json["exemplar_sha256"] = spec.exemplar_sha256;
  json["size"] = {spec.size.width, spec.size.height};
  json["periodic"] = spec.periodic;
  if (spec.step != 1) json["step"] = spec.step;
  if (!spec.gpu.empty()) json["gpu"] = options_to_json(spec.gpu);
  json["seed"] = spec.seed;
  json["samples"] = spec.samples;
  json["metrics"] = spec.metrics;
  json["pictures"] = spec.pictures;
  return json;
}

RunSpec run_spec_from_json(const Json& json) {
  if (!json.is_object()) {
    throw std::invalid_argument(fmt::format("run spec: expected a JSON object, found {}", json.dump()));
  }
  for (const auto& [key, value] : json.items()) {
    if (std::ranges::find(keys, key) == keys.end()) {
      throw std::invalid_argument(fmt::format("run spec: unknown key \"{}\"{}", key, did_you_mean(key, keys)));
    }
  }
  RunSpec spec;
  spec.method = read_text(json, "method");
  spec.params = read_options(json, "params");
  if (json.contains("file_sha256")) {
    const Json& hashes = json["file_sha256"];
    if (!hashes.is_object()) {
      refuse("file_sha256", "an object", hashes);
    }
    for (const auto& [name, hash] : hashes.items()) {
      spec.file_sha256.emplace(name, read_text(hashes, name));
    }
  }
  spec.exemplar = read_text(json, "exemplar");
  spec.exemplar_sha256 = read_text(json, "exemplar_sha256");
  const Json& size = require(json, "size");
  if (!size.is_array() || size.size() != 2) {
    refuse("size", "[width, height]", size);
  }
  spec.size = {read_int(size[0], "size", 0), read_int(size[1], "size", 0)};
  const Json& periodic = require(json, "periodic");
  if (!periodic.is_boolean()) {
    refuse("periodic", "true or false", periodic);
  }
  spec.periodic = periodic.get<bool>();
  if (json.contains("step")) {
    if (!json["step"].is_number()) refuse("step", "a number", json["step"]);
    spec.step = json["step"].get<double>();
  }
  if (json.contains("gpu")) spec.gpu = read_options(json, "gpu");
  spec.seed = read_whole(require(json, "seed"), "seed", 0, std::numeric_limits<std::uint64_t>::max());
  spec.samples = read_int(require(json, "samples"), "samples", 1);
  spec.metrics = read_names(json, "metrics");
  spec.pictures = read_names(json, "pictures");
  return spec;
}

std::string code_version(const std::string& method, std::span<const std::string> metrics, bool on_gpu) {
  // A plan of many runs asks for the same again and again.
  thread_local std::string last_method, last_version;
  thread_local std::vector<std::string> last_metrics;
  thread_local bool last_on_gpu = false;
  if (!last_version.empty() && last_on_gpu == on_gpu && last_method == method &&
      std::ranges::equal(last_metrics, metrics)) {
    return last_version;
  }
  std::set<std::string_view> sources;
  for (const std::string& name : metrics) {
    if (const std::string_view source = find_metric(name).source; !source.empty()) sources.insert(source);
  }
  std::string versions = fmt::format("{} {} {} {}", source_version("experiments/execute"),
                                     source_version("experiments/procedural_exemplars"), method_version(floor_method),
                                     method_version(method));
  if (on_gpu) versions += fmt::format(" {}", source_version("experiments/gpu_run"));
  for (const std::string_view source : sources) {
    versions += fmt::format(" {}", source_version(fmt::format("experiments/metrics/{}", source)));
  }
  last_method = method;
  last_metrics.assign(metrics.begin(), metrics.end());
  last_on_gpu = on_gpu;
  return last_version = sha256(versions).substr(0, 16);
}

std::string code_version(const RunSpec& spec) { return code_version(spec.method, spec.metrics, !spec.gpu.empty()); }

std::string run_id(const RunSpec& spec) {
  return sha256(to_json(spec).dump() + "\ncode " + code_version(spec)).substr(0, 16);
}

std::map<std::string, ParamValue> options_of(const RunSpec& spec) {
  std::map<std::string, ParamValue> options = spec.params;
  for (const auto& [name, value] : spec.gpu) options.emplace("gpu." + name, value);
  return options;
}

std::string command_line(const RunSpec& spec) {
  std::string command = fmt::format("textonbench measure {} {}", quote(spec.method), quote(spec.exemplar));
  for (const auto& [name, value] : spec.params) {
    command += " -p " + quote(fmt::format("{}={}", name, to_string(value)));
  }
  for (const auto& [name, value] : spec.gpu) {
    command += " --gpu " + quote(fmt::format("{}={}", name, to_string(value)));
  }
  // On the command line a sample is a torus unless a size is given.
  if (spec.size != Extent{}) {
    command += fmt::format(" --size {}x{}{}", spec.size.width, spec.size.height, spec.periodic ? " --periodic" : "");
  } else if (!spec.periodic) {
    command += " --no-periodic";
  }
  if (spec.step != 1) command += fmt::format(" --step {}", spec.step);
  return command + fmt::format(" --seed {} --samples {}", spec.seed, spec.samples);
}

}  // namespace textonbench
