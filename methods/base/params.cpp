#include "methods/base/params.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

namespace textonbench {
namespace {

constexpr std::string_view kind_names[] = {"true or false", "a whole number", "a number", "a text"};

std::string describe(const ParamSpec& spec) {
  if (!spec.choices.empty()) {
    return fmt::format("one of {}", fmt::join(spec.choices, ", "));
  }
  const auto kind = kind_names[spec.default_value.index()];
  if (std::isfinite(spec.min) && std::isfinite(spec.max)) {
    return fmt::format("{} in [{}, {}]", kind, spec.min, spec.max);
  }
  if (std::isfinite(spec.min)) {
    return fmt::format("{}, at least {}", kind, spec.min);
  }
  if (std::isfinite(spec.max)) {
    return fmt::format("{}, at most {}", kind, spec.max);
  }
  return std::string(kind);
}

[[noreturn]] void fail(const ParamSpec& spec, std::string_view found) {
  throw ParamError(std::string(spec.name),
                   fmt::format("parameter {} = {}: expected {}", spec.name, found, describe(spec)));
}

void check(const ParamSpec& spec, const ParamValue& value) {
  double number = 0;
  if (const auto* integer = std::get_if<std::int64_t>(&value)) {
    number = static_cast<double>(*integer);
  } else if (const auto* real = std::get_if<double>(&value)) {
    number = *real;
  } else if (const auto* text = std::get_if<std::string>(&value)) {
    if (!spec.choices.empty() && std::ranges::find(spec.choices, *text) == spec.choices.end()) {
      throw ParamError(std::string(spec.name), fmt::format("parameter {} = \"{}\": expected {}{}", spec.name, *text,
                                                           describe(spec), did_you_mean(*text, spec.choices)));
    }
    return;
  } else {
    return;
  }
  if (!std::isfinite(number) || number < spec.min || number > spec.max) {
    fail(spec, to_string(value));
  }
}

const ParamSpec& find_spec(std::span<const ParamSpec> specs, std::string_view name) {
  const auto found = std::ranges::find(specs, name, &ParamSpec::name);
  if (found != specs.end()) {
    return *found;
  }
  std::vector<std::string_view> names;
  std::ranges::transform(specs, std::back_inserter(names), &ParamSpec::name);
  const std::string known =
      names.empty() ? "this method has none" : fmt::format("known are {}", fmt::join(names, ", "));
  throw ParamError(std::string(name),
                   fmt::format("unknown parameter \"{}\"{}: {}", name, did_you_mean(name, names), known));
}

template <class T>
ParamValue parse_number(const ParamSpec& spec, std::string_view text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) {
    fail(spec, fmt::format("\"{}\"", text));
  }
  return value;
}

}  // namespace

std::string to_string(const ParamValue& value) {
  return std::visit([](const auto& v) { return fmt::format("{}", v); }, value);
}

Params::Params(std::span<const ParamSpec> specs, const std::map<std::string, ParamValue>& given) {
  for (const ParamSpec& spec : specs) {
    values_[std::string(spec.name)] = spec.default_value;
  }
  for (const auto& [name, value] : given) {
    const ParamSpec& spec = find_spec(specs, name);
    ParamValue converted = value;
    if (std::holds_alternative<double>(spec.default_value) && std::holds_alternative<std::int64_t>(value)) {
      converted = static_cast<double>(std::get<std::int64_t>(value));
    }
    if (converted.index() != spec.default_value.index()) {
      fail(spec,
           std::holds_alternative<std::string>(value) ? fmt::format("\"{}\"", to_string(value)) : to_string(value));
    }
    check(spec, converted);
    values_[name] = std::move(converted);
  }
}

const ParamValue& Params::find(std::string_view name) const {
  const auto found = values_.find(std::string(name));
  if (found == values_.end()) {
    throw std::logic_error(fmt::format("parameter \"{}\" is not described by its method", name));
  }
  return found->second;
}

bool Params::boolean(std::string_view name) const { return std::get<bool>(find(name)); }

std::int64_t Params::integer(std::string_view name) const { return std::get<std::int64_t>(find(name)); }

double Params::number(std::string_view name) const { return std::get<double>(find(name)); }

const std::string& Params::text(std::string_view name) const { return std::get<std::string>(find(name)); }

std::pair<std::string, ParamValue> parse_param(std::span<const ParamSpec> specs, std::string_view assignment) {
  const auto equals = assignment.find('=');
  if (equals == std::string_view::npos || equals == 0) {
    throw ParamError(std::string(assignment), fmt::format("parameter \"{}\": expected name=value", assignment));
  }
  const std::string_view name = assignment.substr(0, equals);
  const std::string_view text = assignment.substr(equals + 1);
  const ParamSpec& spec = find_spec(specs, name);
  ParamValue value;
  if (std::holds_alternative<bool>(spec.default_value)) {
    if (text != "true" && text != "false") {
      fail(spec, fmt::format("\"{}\"", text));
    }
    value = text == "true";
  } else if (std::holds_alternative<std::int64_t>(spec.default_value)) {
    value = parse_number<std::int64_t>(spec, text);
  } else if (std::holds_alternative<double>(spec.default_value)) {
    value = parse_number<double>(spec, text);
  } else {
    value = std::string(text);
  }
  check(spec, value);
  return {std::string(name), std::move(value)};
}

std::string_view nearest_name(std::string_view name, std::span<const std::string_view> candidates) {
  std::string_view nearest;
  std::size_t least = std::max<std::size_t>(2, name.size() / 3) + 1;
  for (const std::string_view candidate : candidates) {
    // Levenshtein's distance, one row at a time.
    std::vector<std::size_t> distance(candidate.size() + 1);
    std::iota(distance.begin(), distance.end(), std::size_t{0});
    for (std::size_t i = 0; i < name.size(); ++i) {
      std::size_t diagonal = distance[0];
      distance[0] = i + 1;
      for (std::size_t j = 0; j < candidate.size(); ++j) {
        const std::size_t substituted = diagonal + (name[i] == candidate[j] ? 0 : 1);
        diagonal = distance[j + 1];
        distance[j + 1] = std::min({substituted, distance[j] + 1, distance[j + 1] + 1});
      }
    }
    // A name of which every letter would change is not near.
    if (distance.back() < std::min(least, std::max(name.size(), candidate.size()))) {
      least = distance.back();
      nearest = candidate;
    }
  }
  return nearest;
}

std::string did_you_mean(std::string_view name, std::span<const std::string_view> candidates) {
  const std::string_view nearest = nearest_name(name, candidates);
  return nearest.empty() ? std::string() : fmt::format(" (did you mean \"{}\"?)", nearest);
}

}  // namespace textonbench
