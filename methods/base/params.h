// Options of a method: described once, checked once. Algorithms never see this type; their adapters read it.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace textonbench {

using ParamValue = std::variant<bool, std::int64_t, double, std::string>;

/// "3", "0.5", "true" or the text itself: as written on a command line and in a config.
std::string to_string(const ParamValue& value);

/// Description of one option. Its kind is that of its default value.
struct ParamSpec {
  std::string_view name;
  ParamValue default_value;
  std::string_view unit;  ///< "pixel", "1/pixel", … ; empty when it has none; "file": a path,
                          ///< whose content counts; "exemplar": the name of one, or the path of a picture;
                          ///< "mask": a description (methods/base/masks.h), or the path of a picture
  std::string_view help;
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  std::vector<std::string_view> choices = {};  ///< of a text option: what is allowed
};

/// A bad option: `name` says which one, what() what was expected.
class ParamError : public std::invalid_argument {
 public:
  ParamError(std::string name, const std::string& message) : std::invalid_argument(message), name_(std::move(name)) {}
  const std::string& name() const { return name_; }

 private:
  std::string name_;
};

/// A complete, checked set of options: every described name has a value of the described kind and in range.
class Params {
 public:
  /// Defaults overridden by `given`. A whole number is accepted where a real one is expected. Throws ParamError for an
  /// unknown name (with the nearest known one), a wrong kind, a value out of range, infinite, NaN or not among the
  /// choices.
  Params(std::span<const ParamSpec> specs, const std::map<std::string, ParamValue>& given);

  bool boolean(std::string_view name) const;
  std::int64_t integer(std::string_view name) const;
  double number(std::string_view name) const;
  const std::string& text(std::string_view name) const;

  /// All options, defaults included, by name.
  const std::map<std::string, ParamValue>& values() const { return values_; }

 private:
  const ParamValue& find(std::string_view name) const;
  std::map<std::string, ParamValue> values_;
};

/// Reads "name=value" from a command line into the kind that `specs` gives that name. Throws ParamError.
std::pair<std::string, ParamValue> parse_param(std::span<const ParamSpec> specs, std::string_view assignment);

/// The candidate nearest to `name` in edit distance, or empty when none is near: for "did you mean …?".
std::string_view nearest_name(std::string_view name, std::span<const std::string_view> candidates);

/// ` (did you mean "x"?)` or an empty string.
std::string did_you_mean(std::string_view name, std::span<const std::string_view> candidates);

}  // namespace textonbench
