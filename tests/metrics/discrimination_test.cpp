// The exact law scores near each metric's floor, and models that are wrong in one respect are caught by the metrics
// that look at it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/metrics/metric_fixture.h"

namespace textonbench::discrimination_test {

constexpr int count = 8;

class Discrimination : public testing::Test {
 protected:
  MetricValue of(std::string_view metric, const std::vector<Image>& samples) const {
    return measure(metric, target_, samples, domain_);
  }

  /// The metric is `factor` times that of the exact law, and above it by more than 6 standard errors.
  void expect_caught(std::string_view metric, const std::vector<Image>& samples, double factor) const {
    const MetricValue good = of(metric, exact_), bad = of(metric, samples);
    EXPECT_GT(std::abs(bad.value), factor * std::abs(good.value)) << metric;
    EXPECT_GT(std::abs(bad.value) - std::abs(good.value), 6 * std::hypot(*good.stderr_value, *bad.stderr_value))
        << metric;
  }

  std::vector<Image> exact_with(Image (*change)(const Image&, const Target&)) const {
    std::vector<Image> changed;
    changed.reserve(exact_.size());
    for (const Image& sample : exact_) changed.push_back(change(sample, target_));
    return changed;
  }

  const Exemplar exemplar_ = smooth_exemplar({128, 128}, 3, 1.2, 2);
  const Target target_ = make_target(exemplar_);
  const Domain domain_{.size = {128, 128}, .periodic = true};
  const std::vector<Image> exact_ = draw("adsn", {}, exemplar_, domain_, count, 11);
};

// Each bound is more than 4 standard deviations above the mean over 60 other seeds, so a false alarm has a probability
// below 1e-3 a metric.
TEST_F(Discrimination, TheExactLawScoresTheFloor) {
  for (const bool periodic : {true, false}) {
    const Domain domain{.size = {128, 128}, .periodic = periodic};
    const std::vector<Image> samples = draw("adsn", {}, exemplar_, domain, count, 12);
    const auto value = [&](std::string_view metric) { return measure(metric, target_, samples, domain).value; };
    EXPECT_LT(value("mean_error"), periodic ? 1e-5 : 0.05);
    EXPECT_LT(value("color_covariance_error"), 0.035);
    EXPECT_LT(value("autocovariance_error_8"), 0.14);
    EXPECT_LT(value("autocovariance_error_32"), 0.34);
    EXPECT_LT(value("autocovariance_error_quarter"), 0.34);
    EXPECT_LT(value("log_spectral_distance"), 0.85);
    EXPECT_LT(std::abs(value("skewness")), 0.06);
    EXPECT_LT(std::abs(value("excess_kurtosis")), 0.12);
    EXPECT_NEAR(value("cramer_von_mises"), 1.0 / 6, 0.18);
    EXPECT_LT(value("patch_distance"), 0.02);
  }
}

TEST_F(Discrimination, FalseColorsOfARandomPhaseThatReplacesTheExemplars) {
  const auto wrong = draw("rpn", {{"phase", std::string("replaced")}}, exemplar_, domain_, count, 13);
  expect_caught("color_covariance_error", wrong, 5);
  expect_caught("autocovariance_error_8", wrong, 4);
  expect_caught("patch_distance", wrong, 3);
  // Each channel by itself is right.
  EXPECT_LT(of("log_spectral_distance", wrong).value, 1e-3);
}

TEST_F(Discrimination, Blur) {
  const auto wrong = exact_with([](const Image& u, const Target&) { return blurred(u, 0.8); });
  expect_caught("log_spectral_distance", wrong, 3);
  expect_caught("autocovariance_error_8", wrong, 3);
  expect_caught("color_covariance_error", wrong, 3);
  expect_caught("patch_distance", wrong, 1.5);
}

TEST_F(Discrimination, Contrast) {
  const auto wrong = exact_with([](const Image& u, const Target& target) {
    return mapped(u, [&](double value, int c) {
      const double m = target.gaussian.mean[static_cast<std::size_t>(c)];
      return m + 1.25 * (value - m);
    });
  });
  expect_caught("color_covariance_error", wrong, 5);
  expect_caught("autocovariance_error_8", wrong, 4);
  expect_caught("log_spectral_distance", wrong, 2);
  expect_caught("patch_distance", wrong, 3);
  EXPECT_NEAR(of("color_covariance_error", wrong).value, 0.25, 0.05);
}

TEST_F(Discrimination, Brightness) {
  const auto wrong = exact_with(
      [](const Image& u, const Target&) { return mapped(u, [](double value, int) { return value + 0.05; }); });
  expect_caught("mean_error", wrong, 1000);
  expect_caught("patch_distance", wrong, 3);
  EXPECT_NEAR(of("color_covariance_error", wrong).value, of("color_covariance_error", exact_).value, 1e-4);
}

// A log-normal marginal of the target's mean and variance: skewness 1.75, excess kurtosis 5.9.
TEST_F(Discrimination, AMarginalThatIsNotGaussian) {
  const auto wrong = exact_with([](const Image& u, const Target& target) {
    return mapped(u, [&](double value, int c) {
      const double m = target.gaussian.mean[static_cast<std::size_t>(c)];
      const double sd = std::sqrt(target.covariance.at(c, c, 0, 0));
      const double s = 0.5;
      const double log_normal = std::exp(s * (value - m) / sd);
      return m + sd * (log_normal - std::exp(s * s / 2)) / std::sqrt(std::exp(s * s) * (std::exp(s * s) - 1));
    });
  });
  expect_caught("skewness", wrong, 10);
  EXPECT_GT(of("excess_kurtosis", wrong).value, 2.5);
  EXPECT_NEAR(of("skewness", wrong).value, 1.75, 0.3);
  EXPECT_GT(of("cramer_von_mises", wrong).value, 0.461);
  EXPECT_GT(of("patch_distance", wrong).value, 2 * of("patch_distance", exact_).value);
  EXPECT_LT(of("color_covariance_error", wrong).value, 0.06);
}

TEST_F(Discrimination, MeasuringTwiceGivesTheSameBits) {
  for (const MetricEntry& entry : metric_catalog()) {
    if (entry.of_samples == nullptr) continue;
    EXPECT_EQ(of(entry.name, exact_).value, of(entry.name, exact_).value) << entry.name;
  }
}

}  // namespace textonbench::discrimination_test
