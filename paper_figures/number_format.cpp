#include "paper_figures/number_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace textonbench {
namespace {

constexpr int least_fixed_exponent = -3;
constexpr int first_large_exponent = 6;
constexpr int most_digits = 6;

bool needs_power_of_ten(int exponent) { return exponent < least_fixed_exponent || exponent >= first_large_exponent; }

int exponent_of(double value) { return value == 0 ? 0 : static_cast<int>(std::floor(std::log10(std::abs(value)))); }

std::string fixed(double value, int decimals) {
  std::string text = fmt::format("{:.{}f}", value, std::max(decimals, 0));
  const bool is_zero = text.find_first_of("123456789") == std::string::npos;
  return is_zero && text.front() == '-' ? text.substr(1) : text;
}

}  // namespace

FormattedValue format_value(double value, std::optional<double> error) {
  if (!std::isfinite(value)) return {"–", ""};
  if (!error || !std::isfinite(*error) || *error <= 0) return {format_number(value), ""};
  const int exponent = exponent_of(std::max(std::abs(value), *error));
  const bool scientific = needs_power_of_ten(exponent);
  const double scale = scientific ? std::pow(10.0, -exponent) : 1.0;
  const std::string suffix = scientific ? "·" + format_power_of_ten(exponent) : "";
  const int value_exponent = scientific ? 0 : exponent;
  const int wanted = 1 - exponent_of(*error * scale);
  const int decimals = std::max(0, std::min(wanted, most_digits - 1 - value_exponent));
  return {fixed(value * scale, decimals) + suffix,
          decimals < std::max(wanted, 0) ? format_number(*error, 2) : fixed(*error * scale, decimals) + suffix};
}

std::string format_number(double value, int digits) {
  if (!std::isfinite(value)) return "–";
  if (value == 0) return "0";
  const int exponent = exponent_of(value);
  if (!needs_power_of_ten(exponent)) return fixed(value, digits - 1 - exponent);
  return fixed(value * std::pow(10.0, -exponent), digits - 1) + "·" + format_power_of_ten(exponent);
}

std::string format_plain(double value, std::optional<double> error) {
  const FormattedValue text = format_value(value, error);
  return text.error.empty() ? text.value : text.value + " ± " + text.error;
}

std::string format_power_of_ten(int exponent) {
  static constexpr std::array<const char*, 10> digits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = exponent < 0 ? "10⁻" : "10";
  for (const char c : std::to_string(std::abs(exponent))) text += digits.at(static_cast<std::size_t>(c - '0'));
  return text;
}

std::string format_exact(double value) { return fmt::format("{}", value); }

std::string format_size(int width, int height) { return fmt::format("{} × {}", width, height); }

std::string format_bytes(double bytes) {
  static constexpr std::array<const char*, 5> units{"B", "KiB", "MiB", "GiB", "TiB"};
  std::size_t unit = 0;
  for (; bytes >= 1024 && unit + 1 < units.size(); ++unit) bytes /= 1024;
  return fmt::format("{:.{}f} {}", bytes, unit == 0 || bytes >= 100 ? 0 : 1, units.at(unit));
}

}  // namespace textonbench
