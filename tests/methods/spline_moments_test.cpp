#include "methods/spot/spline_moments.h"

#include <gtest/gtest.h>

#include <cmath>

#include "methods/base/bspline.h"
#include "methods/base/random.h"
#include "methods/spot/kernel_moments.h"

namespace textonbench::spline_moments_test {

SplineTexton random_texton(int order, Extent extent, std::uint64_t kernels) {
  SplineTexton texton{.coefficients = {}, .order = order};
  texton.coefficients.support_pixels = extent.area();
  texton.coefficients.mean = {0};
  texton.support_area = (extent.width + order) * (extent.height + order);
  for (std::uint64_t k = 0; k < kernels; ++k) {
    Image& alpha = texton.coefficients.kernels.emplace_back(extent, 1);
    for (int y = 0; y < extent.height; ++y) {
      fill_normal(Stream(Seed{k}), static_cast<std::uint64_t>(y), 0, alpha.row(0, y));
    }
  }
  return texton;
}

TEST(SplineMoments, OfOrderZeroAreThoseOfTheKernelsPixels) {
  const SplineTexton texton = random_texton(0, {7, 5}, 3);
  EXPECT_NEAR(spline_kurtosis(texton)[0], poisson_moments(texton.coefficients, 1)[0].excess_kurtosis, 1e-12);
}

/// One coefficient: A ∫ β⁴ ∫ β⁴ / (∫ β²)⁴ by the midpoint rule, whose error here is below 1e-7.
TEST(SplineMoments, OfOneSplineAreThoseOfItsIntegrals) {
  for (int order = 1; order <= max_bspline_order; ++order) {
    SplineTexton texton = random_texton(order, {1, 1}, 1);
    constexpr int steps = 60000;
    double second = 0;
    double fourth = 0;
    for (int i = 0; i < steps; ++i) {
      const double b = bspline(order, 3 * (2.0 * i + 1 - steps) / steps);
      second += 6 * b * b / steps;
      fourth += 6 * b * b * b * b / steps;
    }
    const double expected = (order + 1) * (order + 1) * std::pow(fourth / (second * second), 2);
    EXPECT_NEAR(spline_kurtosis(texton)[0], expected, 1e-6 * expected) << order;
  }
}

TEST(SplineMoments, OfAChannelWithoutValuesAreZero) {
  SplineTexton texton = random_texton(1, {3, 3}, 1);
  texton.coefficients.kernels[0] = Image({3, 3}, 1);
  EXPECT_EQ(spline_kurtosis(texton)[0], 0);
}

}  // namespace textonbench::spline_moments_test
