#include <gtest/gtest.h>

#include <cmath>

#include "tests/metrics/metric_fixture.h"

namespace textonbench::color_covariance_test {

constexpr Extent extent{32, 24};
constexpr Domain domain{.size = extent, .periodic = true};

// For two diagonal covariances the Bures distance is the Euclidean distance of the standard deviations.
TEST(ColorCovariance, OfUncorrelatedChannelsComparesDeviations) {
  Exemplar exemplar{"waves", Image(extent, 3), std::string(64, '0')};
  for (int y = 0; y < extent.height; ++y) {
    for (int x = 0; x < extent.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        // The same on both borders, so the periodic component is the image itself.
        const double phase = 2 * std::numbers::pi * (c + 1) * (x + 0.5) / extent.width;
        exemplar.pixels.at(c, x, y) = static_cast<float>(0.5 + 0.1 * (c + 1) * std::cos(phase));
      }
    }
  }
  const Target target = make_target(exemplar);
  const std::vector<double> gain{1.5, 0.5, 2};
  const std::vector<Image> samples{mapped(target.periodic_component, [&](double value, int c) {
    return 0.7 + gain[static_cast<std::size_t>(c)] * (value - 0.5);
  })};
  const double squared = 0.25 * 1 + 0.25 * 4 + 1 * 9, trace = 1 + 4 + 9;
  EXPECT_NEAR(measure("color_covariance_error", target, samples, domain).value, std::sqrt(squared / trace), 1e-4);
}

TEST(ColorCovariance, SeesContrastAndNotTheMean) {
  const Exemplar exemplar = smooth_exemplar(extent, 3);
  const Target target = make_target(exemplar);
  const auto with = [&](double contrast, double shift) {
    return std::vector<Image>{
        mapped(target.periodic_component, [&](double value, int) { return shift + contrast * value; })};
  };
  // The square root of a float32 rounding error of the moments.
  EXPECT_NEAR(measure("color_covariance_error", target, with(1, 0), domain).value, 0, 1e-3);
  EXPECT_NEAR(measure("color_covariance_error", target, with(1.3, 0.2), domain).value, 0.3, 1e-4);
  EXPECT_NEAR(measure("color_covariance_error", target, with(0, 0.4), domain).value, 1, 1e-3);
}

}  // namespace textonbench::color_covariance_test
