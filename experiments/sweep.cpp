#include "experiments/sweep.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <string_view>

#include "experiments/gpu_run.h"
#include "experiments/toml_reader.h"

namespace textonbench {
namespace {

/// Positions in Sweep's list of axes.
enum Axis : std::size_t { method_axis, exemplar_axis, size_axis, periodic_axis, first_param_axis };

}  // namespace

SourcePlace place_of(const RunsTable& table, const std::string& path) {
  for (const std::string& candidate : {path, path.substr(0, path.rfind('['))}) {
    if (const auto found = table.places.find(candidate); found != table.places.end()) {
      return found->second;
    }
  }
  return table.place;
}

bool Exclusion::matches(const RunSpec& run) const {
  return (!method || run.method == *method) && (!exemplar || run.exemplar == *exemplar) &&
         (!seed || run.seed == *seed) && std::ranges::all_of(params, [&](const auto& param) {
           const auto own = run.params.find(param.first);
           return own != run.params.end() && own->second == param.second;
         });
}

Sweep::Sweep(const RunsTable& table, SweepChoices choices, const ExemplarCatalog& catalog)
    : table_(table),
      choices_(std::move(choices)),
      catalog_(catalog),
      params_(table.params.begin(), table.params.end()),
      gpu_(table.gpu.begin(), table.gpu.end()) {
  axes_ = {{"method", choices_.methods.size()},
           {"exemplars", choices_.exemplars.size()},
           {"size", table.sizes.size()},
           {"periodic", table.periodic.size()}};
  for (const auto& [name, values] : params_) {
    const std::string path = "params." + name;
    axes_.emplace_back(path, values.size());
    for (const MethodEntry* method : choices_.methods) {
      for (std::size_t i = 0; i < values.size(); ++i) {
        check_param(*method, name, values[i], path, fmt::format("{}[{}]", path, i));
      }
    }
  }
  add_gpu_axes();
  axes_.emplace_back("seeds", table.seeds.size());
  if (table.combine == Combine::zip) {
    check_zip();
  }
  if (table.combine == Combine::ablate) {
    check_ablation();
  }
  for (std::size_t i = 0; i < table.exclude.size(); ++i) {
    exclusions_.push_back(read_exclusion(i));
  }
}

void Sweep::add_gpu_axes() {
  const std::span<const ParamSpec> options = gpu_run_options();
  for (const auto& [name, values] : gpu_) {
    const std::string path = "gpu." + name;
    axes_.emplace_back(path, values.size());
    const bool known = std::ranges::find(options, name, &ParamSpec::name) != options.end();
    for (std::size_t i = 0; i < values.size(); ++i) {
      at_place(table_, known ? fmt::format("{}[{}]", path, i) : key_path(path), [&, &key = name, &value = values[i]] {
        return Params(options, {{key, value}}).values();
      });
    }
  }
}

std::size_t Sweep::count() const {
  constexpr std::size_t largest = std::numeric_limits<std::size_t>::max();
  std::size_t product = 1;
  std::size_t longest = 1;
  const auto multiply = [&](std::size_t length) {
    product = product <= largest / length ? product * length : largest;
    longest = std::max(longest, length);
  };
  for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
    if (table_.combine != Combine::ablate || !is_param(axis)) {
      multiply(axes_[axis].second);
    }
  }
  if (table_.combine == Combine::ablate) {
    multiply(ablation_count());
  }
  return table_.combine == Combine::zip ? longest : product;
}

void Sweep::expand(const std::function<void(RunSpec, const ChosenExemplar&)>& take) const {
  const std::size_t runs = count();
  bool any = false;
  for (std::size_t run = 0; run < runs; ++run) {
    const std::vector<std::size_t> digits = table_.combine == Combine::zip ? zip_digits(run) : grid_digits(run);
    RunSpec spec = make_spec(digits);
    if (std::ranges::none_of(exclusions_, [&](const Exclusion& exclusion) { return exclusion.matches(spec); })) {
      any = true;
      take(std::move(spec), *choices_.exemplars[digits[exemplar_axis]]);
    }
  }
  if (!any) {
    throw ConfigError(place_of(table_, "exclude"), "empty sweep: exclude leaves no run");
  }
}

bool Sweep::is_param(std::size_t axis) const {
  return axis >= first_param_axis && axis < first_param_axis + params_.size();
}

/// The base, and every further value of every parameter.
std::size_t Sweep::ablation_count() const {
  std::size_t settings = 1;
  for (const auto& [name, values] : params_) {
    settings += values.size() - 1;
  }
  return settings;
}

std::vector<std::size_t> Sweep::zip_digits(std::size_t run) const {
  std::vector<std::size_t> digits;
  for (const auto& [path, length] : axes_) {
    digits.push_back(std::min(run, length - 1));
  }
  return digits;
}

/// Of an ablation, all parameters together are one axis of the grid.
std::vector<std::size_t> Sweep::grid_digits(std::size_t run) const {
  std::vector<std::size_t> digits(axes_.size());
  const auto take_digit = [&](std::size_t length) {
    const std::size_t digit = run % length;
    run /= length;
    return digit;
  };
  for (std::size_t axis = axes_.size(); axis-- > 0;) {
    if (table_.combine != Combine::ablate || !is_param(axis)) {
      digits[axis] = take_digit(axes_[axis].second);
    } else if (axis == first_param_axis) {
      std::size_t change = take_digit(ablation_count());
      std::size_t changed = axis;
      while (is_param(changed) && change > axes_[changed].second - 1) {
        change -= axes_[changed++].second - 1;
      }
      digits[changed] = change;
    }
  }
  return digits;
}

void Sweep::check_ablation() const {
  if (ablation_count() == 1) {
    throw ConfigError(
        place_of(table_, "combine"),
        "combine = \"ablate\": expected a parameter with at least two values, the first its base, in params");
  }
}

void Sweep::check_zip() const {
  const auto longest = std::ranges::max_element(axes_, {}, &std::pair<std::string, std::size_t>::second);
  for (const auto& [path, length] : axes_) {
    if (length != 1 && length != longest->second) {
      throw ConfigError(place_of(table_, path), fmt::format("combine = \"zip\": {} has {} values where {} has {}", path,
                                                            length, longest->first, longest->second));
    }
  }
}

/// The value as the method takes it. A name that the method lacks is told at its key, a bad value where it stands.
ParamValue Sweep::check_param(const MethodEntry& method, const std::string& name, const ParamValue& value,
                              const std::string& path, const std::string& element) const {
  const bool known = std::ranges::find(method.params, name, &ParamSpec::name) != method.params.end();
  return at_place(table_, known ? element : key_path(path), [&] {
    try {
      return Params(method.params, {{name, value}}).values().at(name);
    } catch (const ParamError& error) {
      throw std::invalid_argument(fmt::format("method {}: {}", method.name, error.what()));
    }
  });
}

Exclusion Sweep::read_exclusion(std::size_t index) const {
  Exclusion exclusion;
  for (const auto& [key, value] : table_.exclude[index]) {
    const std::string path = fmt::format("exclude[{}].{}", index, key);
    const std::string text = to_string(value);
    if (key == "method") {
      exclusion.method = at_place(table_, path, [&] { return std::string(find_method(text).name); });
    } else if (key == "exemplar") {
      exclusion.exemplar = at_place(table_, path, [&] { return catalog_.look_up(text).name; });
    } else if (key == "seed") {
      const std::int64_t* seed = std::get_if<std::int64_t>(&value);
      if (seed == nullptr || *seed < 0) {
        throw ConfigError(place_of(table_, path),
                          fmt::format("exclude: seed: expected a whole number of at least 0, found {}", text));
      }
      exclusion.seed = static_cast<std::uint64_t>(*seed);
    } else {
      exclusion.params.emplace(key, read_exclusion_param(key, value, path));
    }
  }
  return exclusion;
}

/// Excluding by a parameter makes sense as soon as one of the methods has it.
ParamValue Sweep::read_exclusion_param(const std::string& name, const ParamValue& value,
                                       const std::string& path) const {
  std::vector<std::string_view> known{"method", "exemplar", "seed"};
  for (const MethodEntry* method : choices_.methods) {
    for (const ParamSpec& spec : method->params) {
      if (spec.name == name) {
        return check_param(*method, name, value, path, path);
      }
      if (std::ranges::find(known, spec.name) == known.end()) {
        known.push_back(spec.name);
      }
    }
  }
  throw ConfigError(place_of(table_, key_path(path)),
                    fmt::format("unknown key \"{}\" in exclude{}; expected one of: {}", name, did_you_mean(name, known),
                                fmt::join(known, ", ")));
}

RunSpec Sweep::make_spec(const std::vector<std::size_t>& digits) const {
  const MethodEntry& method = *choices_.methods[digits[method_axis]];
  const ChosenExemplar& exemplar = *choices_.exemplars[digits[exemplar_axis]];
  std::map<std::string, ParamValue> given;
  for (std::size_t i = 0; i < params_.size(); ++i) {
    given.emplace(params_[i].first, params_[i].second[digits[first_param_axis + i]]);
  }
  const std::map<std::string, ParamValue> params = Params(method.params, given).values();
  std::map<std::string, ParamValue> given_gpu;
  for (std::size_t i = 0; i < gpu_.size(); ++i) {
    given_gpu.emplace(gpu_[i].first, gpu_[i].second[digits[first_param_axis + params_.size() + i]]);
  }
  std::map<std::string, std::string> files =
      at_place(table_, "params", [&] { return hash_named(method, params, catalog_); });
  return {.method = std::string(method.name),
          .params = params,
          .file_sha256 = std::move(files),
          .exemplar = exemplar.info->name,
          .exemplar_sha256 = exemplar.sha256,
          .size = table_.sizes[digits[size_axis]],
          .periodic = table_.periodic[digits[periodic_axis]],
          .step = table_.step,
          .gpu = gpu_.empty() ? given_gpu : Params(gpu_run_options(), given_gpu).values(),
          .seed = table_.seeds[digits.back()],
          .samples = table_.samples,
          .metrics = choices_.metrics,
          .pictures = choices_.pictures,
          .timeout_seconds = table_.timeout_seconds,
          .memory_limit_mb = table_.memory_limit_mb};
}

}  // namespace textonbench
