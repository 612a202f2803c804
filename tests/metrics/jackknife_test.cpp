#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "tests/metrics/metric_fixture.h"

namespace textonbench::jackknife_test {

using testing::HasSubstr;

constexpr Domain one_pixel{.size = {1, 1}, .periodic = true};

/// Powers 1 and 2 of the one pixel of a sample, and any function of their averages.
class FunctionOfPowers : public SampleMetric {
 public:
  explicit FunctionOfPowers(double (*function)(double, double)) : function_(function) {}
  std::vector<float> statistic(const Image& sample, const Domain&) const override {
    const float x = sample.at(0, 0, 0);
    return {x, x * x};
  }
  double value(std::span<const double> mean) const override { return function_(mean[0], mean[1]); }

 private:
  double (*function_)(double, double);
};

std::vector<Image> pixels(std::span<const float> values) {
  std::vector<Image> samples;
  samples.reserve(values.size());
  for (const float value : values) samples.emplace_back(Extent{1, 1}, 1).at(0, 0, 0) = value;
  return samples;
}

TEST(Jackknife, OfTheMeanIsTheTextbookStandardError) {
  const std::vector<float> values{1, 4, 2, 8, 5, 7};
  const MetricValue mean =
      measure_samples(FunctionOfPowers([](double m, double) { return m; }), pixels(values), one_pixel);
  EXPECT_DOUBLE_EQ(mean.value, 27.0 / 6);
  // s² = (Σ x² − (Σ x)² / K) / (K − 1) = (159 − 121.5) / 5
  ASSERT_TRUE(mean.stderr_value);
  EXPECT_NEAR(*mean.stderr_value, std::sqrt(7.5 / 6), 1e-12);
  EXPECT_FALSE(mean.floor);
}

// The standard deviation of 20 normal variates: over 4000 repetitions the mean squared jackknife error is the variance
// of the estimate to within 8 % (the jackknife's bias here is 3 %, its Monte Carlo error 2 %; more than 5 sd away).
TEST(Jackknife, OfANonlinearFunctionPredictsItsSpread) {
  constexpr int repetitions = 4000, count = 20;
  const FunctionOfPowers deviation([](double m, double square) { return std::sqrt(square - m * m); });
  const Stream stream = Stream(Seed{3}).child("jackknife");
  double sum = 0, squares = 0, predicted = 0;
  for (int r = 0; r < repetitions; ++r) {
    std::vector<float> values(count);
    fill_normal(stream, static_cast<std::uint64_t>(r), 0, values);
    const MetricValue measured = measure_samples(deviation, pixels(values), one_pixel);
    sum += measured.value;
    squares += measured.value * measured.value;
    predicted += *measured.stderr_value * *measured.stderr_value / repetitions;
  }
  const double variance = squares / repetitions - std::pow(sum / repetitions, 2);
  EXPECT_NEAR(predicted / variance, 1, 0.08);
}

TEST(Jackknife, OneSampleHasNoStandardError) {
  const MetricValue one =
      measure_samples(FunctionOfPowers([](double m, double) { return m; }), pixels(std::vector<float>{3}), one_pixel);
  EXPECT_EQ(one.value, 3);
  EXPECT_FALSE(one.stderr_value);
}

TEST(Jackknife, RefusesWhatCannotBeMeasured) {
  const FunctionOfPowers mean([](double m, double) { return m; });
  const auto message = [&](const std::vector<Image>& samples) -> std::string {
    try {
      measure_samples(mean, samples, one_pixel);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "nothing thrown";
  };
  EXPECT_THAT(message({}), HasSubstr("no samples"));
  std::vector<Image> samples = pixels(std::vector<float>{1, std::numeric_limits<float>::quiet_NaN()});
  EXPECT_THAT(message(samples), HasSubstr("sample 2 holds nan at channel 0, pixel (0, 0)"));
  samples.back() = Image({4, 3}, 1);
  EXPECT_THAT(message(samples), HasSubstr("sample 2 is of 4x3 pixels: expected 1x1"));
}

}  // namespace textonbench::jackknife_test
