#include "experiments/metrics/moments.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "tests/metrics/metric_fixture.h"

namespace textonbench::moments_test {

constexpr Extent extent{20, 16};
constexpr Domain domain{.size = extent, .periodic = true};

/// One pixel in four at `high`, the others at `low`, in every channel.
Image two_levels(int channels, float low, float high) {
  Image u(extent, channels);
  for (int c = 0; c < channels; ++c) {
    for (int y = 0; y < u.height(); ++y) {
      for (int x = 0; x < u.width(); ++x) u.at(c, x, y) = x % 2 == 0 && y % 2 == 0 ? high : low;
    }
  }
  return u;
}

TEST(Moments, OfATwoLevelImageAreThoseOfABernoulliVariable) {
  const Exemplar exemplar = smooth_exemplar(extent, 3);
  const Target target = make_target(exemplar);
  const std::vector<Image> samples{two_levels(3, 0.2F, 0.9F)};
  const double p = 0.25, q = 0.75;
  EXPECT_NEAR(measure("skewness", target, samples, domain).value, (q - p) / std::sqrt(p * q), 1e-4);
  EXPECT_NEAR(measure("excess_kurtosis", target, samples, domain).value, (1 - 6 * p * q) / (p * q), 1e-4);
}

// The two samples have different means, so their mixture is not Gaussian although each would be taken for symmetric:
// moments are about the mean of the set.
TEST(Moments, AreThoseOfTheSampleSet) {
  const Exemplar exemplar = smooth_exemplar(extent, 1);
  const Target target = make_target(exemplar);
  const Image low = mapped(Image(extent, 1), [](double, int) { return 0.3; });
  const Image high = mapped(Image(extent, 1), [](double, int) { return 0.6; });
  const MetricValue kurtosis =
      measure("excess_kurtosis", target, {two_levels(1, 0.3F, 0.6F), high, high, low, low}, domain);
  const double p = (0.25 + 2) / 5;
  EXPECT_NEAR(kurtosis.value, (1 - 6 * p * (1 - p)) / (p * (1 - p)), 1e-4);
}

TEST(Moments, MeanErrorIsTheShiftInTargetDeviations) {
  const Exemplar exemplar = smooth_exemplar(extent, 3);
  const Target target = make_target(exemplar);
  const auto shifted = [&](double red, double green, double blue) {
    const double shifts[3] = {red, green, blue};
    return std::vector<Image>{mapped(target.periodic_component, [&](double value, int c) {
      return value + shifts[c] * std::sqrt(target.covariance.at(c, c, 0, 0));
    })};
  };
  EXPECT_NEAR(measure("mean_error", target, shifted(0, 0, 0), domain).value, 0, 1e-6);
  EXPECT_NEAR(measure("mean_error", target, shifted(0.3, -0.3, 0.3), domain).value, 0.3, 1e-6);
  EXPECT_NEAR(measure("mean_error", target, shifted(0.5, 0, 0), domain).value, 0.5 / std::sqrt(3), 1e-6);
}

TEST(Moments, AChannelThatDoesNotVaryHasNoShapeAndBorrowsTheLargestUnit) {
  Exemplar exemplar = smooth_exemplar(extent, 3);
  exemplar.pixels = mapped(exemplar.pixels, [](double value, int c) { return c == 1 ? 0.25 : value; });
  const Target target = make_target(exemplar);
  const Image bernoulli = mapped(two_levels(3, 0.2F, 0.9F), [](double value, int c) { return c == 1 ? 0.25 : value; });
  EXPECT_NEAR(measure("skewness", target, {bernoulli}, domain).value, 0.5 / std::sqrt(0.1875), 1e-4);

  const double unit = std::sqrt(target.covariance.at(0, 0, 0, 0));
  const Image shifted =
      mapped(target.periodic_component, [&](double value, int c) { return c == 1 ? value + 0.6 * unit : value; });
  EXPECT_NEAR(measure("mean_error", target, {shifted}, domain).value, 0.6 / std::sqrt(3), 1e-5);
}

TEST(Moments, OfSamplesThatDoNotVaryAreRefused) {
  const Exemplar exemplar = smooth_exemplar(extent, 3);
  const Target target = make_target(exemplar);
  const std::vector<Image> flat{mapped(Image(extent, 3), [](double, int) { return 0.7; })};
  EXPECT_THROW(measure("skewness", target, flat, domain), std::invalid_argument);
  EXPECT_THROW(measure("excess_kurtosis", target, {Image(target.periodic_component), Image(extent, 3)}, domain),
               std::invalid_argument);
}

}  // namespace textonbench::moments_test
