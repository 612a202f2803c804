// Held to the C library in a wider type. The bounds are those that portable_math.h states, about twice what is
// measured.
#include "methods/base/portable_math.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace textonbench::portable_math_test {

/// |value - exact| / |exact|, where 0 must be met exactly.
double relative_error(long double value, long double exact) {
  return static_cast<double>(exact == 0 ? std::fabs(value) : std::fabs((value - exact) / exact));
}

double log_error(double x) { return relative_error(portable::log(x), std::log(static_cast<long double>(x))); }

double log_error(float x) { return relative_error(portable::log(x), std::log(static_cast<double>(x))); }

TEST(PortableLog, DoubleIsWithinItsBound) {
  double worst = 0;
  for (int i = 1; i <= 1'000'000; ++i) {
    worst = std::max(worst, log_error(0.5 + 1.5 * i / 1e6));
  }
  for (int exponent = -1021; exponent < 1023; ++exponent) {  // every binade, at points that differ between binades
    for (int i = 0; i < 100; ++i) {
      worst = std::max(worst, log_error(std::ldexp(1 + (i + (exponent & 255) / 256.0) / 100, exponent)));
    }
  }
  for (double distance = 0x1p-52; distance < 0.5; distance *= 1.01) {
    worst = std::max({worst, log_error(1 + distance), log_error(1 - distance / 2)});
  }
  EXPECT_LT(worst, 7e-16);
  EXPECT_EQ(portable::log(1.0), 0.0);
}

TEST(PortableLog, FloatIsWithinItsBound) {
  constexpr auto first = std::bit_cast<std::uint32_t>(0x1p-126F);
  constexpr auto infinity = 0x7F800000U;
  double worst = 0;
  for (std::uint32_t bits = first; bits < infinity; bits += 1021) {
    worst = std::max(worst, log_error(std::bit_cast<float>(bits)));
  }
  constexpr auto half = std::bit_cast<std::uint32_t>(0.5F);
  constexpr auto two = std::bit_cast<std::uint32_t>(2.0F);
  for (std::uint32_t bits = half; bits < two; bits += 7) {
    worst = std::max(worst, log_error(std::bit_cast<float>(bits)));
  }
  EXPECT_LT(worst, 3.5e-7);
  EXPECT_EQ(portable::log(1.0F), 0.0F);
}

double cos_sin_error(std::uint32_t turn) {
  float cosine = 0;
  float sine = 0;
  portable::cos_sin(turn, cosine, sine);
  const double angle = 2 * std::numbers::pi * turn / 0x1p32;
  return std::max(std::fabs(cosine - std::cos(angle)), std::fabs(sine - std::sin(angle)));
}

TEST(PortableCosSin, IsWithinItsBound) {
  double worst = 0;
  for (std::uint64_t turn = 0; turn < std::uint64_t{1} << 32; turn += 1021) {
    worst = std::max(worst, cos_sin_error(static_cast<std::uint32_t>(turn)));
  }
  for (std::uint32_t octant = 0; octant < 8; ++octant) {  // where the reduction changes quadrant, and small angles
    for (std::uint32_t distance = 0; distance < 2000; ++distance) {
      worst = std::max({worst, cos_sin_error((octant << 29U) + distance), cos_sin_error((octant << 29U) - distance)});
    }
  }
  EXPECT_LT(worst, 2.5e-7);
}

TEST(PortableCosSin, QuarterTurnsAreExact) {
  const std::vector<std::vector<float>> expected = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  for (std::uint32_t quarter = 0; quarter < 4; ++quarter) {
    std::vector<float> found(2);
    portable::cos_sin(quarter << 30U, found[0], found[1]);
    EXPECT_EQ(found, expected[quarter]) << quarter;
  }
}

}  // namespace textonbench::portable_math_test
