// Logarithm, sine and cosine from additions, multiplications and divisions alone, so that their bits do not depend on
// the C library or on the processor (compile with -ffp-contract=off).
#pragma once

#include <bit>
#include <cstdint>
#include <initializer_list>

namespace textonbench::portable {

/// Natural logarithm of a positive normal double. Relative error below 7e-16.
inline double log(double x) {
  const auto bits = std::bit_cast<std::uint64_t>(x);
  // x = m 2^e with m in [sqrt(1/2), sqrt(2)); then log m = 2 atanh(s), s = (m − 1) / (m + 1), |s| < 0.172.
  const std::uint64_t shifted = bits - 0x3FE6A09E667F3BCDULL;
  const std::int64_t e = static_cast<std::int64_t>(shifted) >> 52;
  const auto m = std::bit_cast<double>(bits - (static_cast<std::uint64_t>(e) << 52));
  const double s = (m - 1.0) / (m + 1.0);
  const double s2 = s * s;
  double series = 1.0 / 23.0;
  for (const double odd : {21.0, 19.0, 17.0, 15.0, 13.0, 11.0, 9.0, 7.0, 5.0, 3.0}) {
    series = series * s2 + 1.0 / odd;
  }
  constexpr double ln2 = 0.69314718055994530942;
  return static_cast<double>(e) * ln2 + (2.0 * s + 2.0 * s * s2 * series);
}

/// Natural logarithm of a positive normal float, written without branches so that loops over it vectorise.
/// Relative error below 3.5e-7.
inline float log(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  const std::uint32_t shifted = bits - 0x3F3504F3U;
  const std::int32_t e = static_cast<std::int32_t>(shifted) >> 23;
  const auto m = std::bit_cast<float>(bits - (static_cast<std::uint32_t>(e) << 23U));
  const float s = (m - 1.0F) / (m + 1.0F);
  const float s2 = s * s;
  const float series = ((((1.0F / 9.0F) * s2 + 1.0F / 7.0F) * s2 + 1.0F / 5.0F) * s2 + 1.0F / 3.0F) * s2;
  constexpr float ln2 = 0.693147181F;
  return static_cast<float>(e) * ln2 + 2.0F * (s + s * series);
}

/// Cosine and sine of the angle 2π turn / 2^32. Absolute error below 2.5e-7.
inline void cos_sin(std::uint32_t turn, float& cosine, float& sine) {
  // The nearest quarter turn is taken off in exact integer arithmetic; |x| <= π/4 is left for the polynomials.
  const std::uint32_t quarter = (turn + 0x20000000U) >> 30U;
  const auto rest = static_cast<std::int32_t>(turn - (quarter << 30U));
  const float x = static_cast<float>(rest) * 1.46291807926715968e-9F;
  const float x2 = x * x;
  const float s = x + x * x2 * (-1.6666654611e-1F + x2 * (8.3321608736e-3F + x2 * -1.9515295891e-4F));
  const float c =
      1.0F - 0.5F * x2 + x2 * x2 * (4.166664568298827e-2F + x2 * (-1.388731625493765e-3F + x2 * 2.443315711809948e-5F));
  const bool odd = (quarter & 1U) != 0;
  const float a = odd ? s : c;
  const float b = odd ? c : s;
  // cos(x + q π/2): c, −s, −c, s;  sin: s, c, −s, −c.
  cosine = ((quarter + 1U) & 2U) != 0 ? -a : a;
  sine = (quarter & 2U) != 0 ? -b : b;
}

}  // namespace textonbench::portable
