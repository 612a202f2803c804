// Numbers as a reader wants them.
#pragma once

#include <optional>
#include <string>

namespace textonbench {

/// `digits` significant digits, powers of ten as "1.573·10⁶" outside [10⁻³, 10⁶). "–" for a number that is not finite.
std::string format_number(double value, int digits = 4);

/// A number with its standard error: the error has two significant digits and the value as many decimals, but at most
/// six significant digits; an error too small to show in them is written by itself.
struct FormattedValue {
  std::string value;
  std::string error;  ///< empty when there is none
};
FormattedValue format_value(double value, std::optional<double> error);

/// "0.4321 ± 0.0023", or the value alone.
std::string format_plain(double value, std::optional<double> error);

/// "10⁻⁸".
std::string format_power_of_ten(int exponent);

/// Shortest decimal that reads back as the same double, for CSV and for sorting.
std::string format_exact(double value);

/// "512 × 512".
std::string format_size(int width, int height);

/// "1.5 MiB".
std::string format_bytes(double bytes);

}  // namespace textonbench
