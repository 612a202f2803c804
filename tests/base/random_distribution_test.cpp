// The laws of the random numbers. Seeds are fixed; every hypothesis test here would reject a right generator with
// probability 1e-6.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "methods/base/random.h"
#include "tests/base/statistics.h"

namespace textonbench::random_distribution_test {

constexpr double false_alarm = 1e-6;

Stream stream_of(std::uint64_t seed) { return Stream(Seed{seed}).child("distribution"); }

/// Moments of n standard normal variates about 0: estimates of E x^k with their variances (E x^2k − (E x^k)²) / n.
void expect_normal_moments(const std::vector<double>& samples) {
  constexpr double expected[] = {0, 1, 0, 3};
  constexpr double variance[] = {1, 2, 15, 96};
  const auto n = static_cast<double>(samples.size());
  for (int k = 1; k <= 4; ++k) {
    double sum = 0;
    for (const double x : samples) {
      sum += std::pow(x, k);
    }
    EXPECT_GT(normal_p_value((sum / n - expected[k - 1]) / std::sqrt(variance[k - 1] / n)), false_alarm)
        << "moment " << k << " is " << sum / n;
  }
}

/// Correlation of n independent pairs of zero mean and unit variance times sqrt(n) is standard normal.
template <class Pairs>
void expect_uncorrelated(std::size_t n, const Pairs& product, const char* what) {
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) {
    sum += product(i);
  }
  EXPECT_GT(normal_p_value(sum / std::sqrt(static_cast<double>(n))), false_alarm) << what;
}

TEST(FillNormal, IsStandardNormal) {
  std::vector<float> row(1'000'000);
  fill_normal(stream_of(1), 0, 0, row);
  const std::vector<double> samples(row.begin(), row.end());
  expect_normal_moments(samples);
  EXPECT_GT(kolmogorov_smirnov_p_value(samples, normal_cdf), false_alarm);
  for (const double x : samples) {
    ASSERT_LE(std::fabs(x), 6.7);
  }
}

TEST(FillNormal, VariatesAreUncorrelated) {
  constexpr std::size_t n = 500'000;
  std::vector<float> row(n + 64);
  std::vector<float> next(n + 64);
  fill_normal(stream_of(2), 7, 0, row);
  fill_normal(stream_of(2), 8, 0, next);
  expect_uncorrelated(
      n, [&](std::size_t i) { return row[i] * next[i]; }, "rows");
  for (const std::size_t lag : {1, 2, 15, 16, 17, 32, 64}) {  // 16: the two variates of one Box-Muller pair
    expect_uncorrelated(
        n, [&](std::size_t i) { return row[i] * row[i + lag]; }, "variates of a row");
    expect_uncorrelated(
        n, [&](std::size_t i) { return (row[i] * row[i] - 1) * (row[i + lag] * row[i + lag] - 1) / 2; }, "squares");
  }
}

TEST(FillPhasor, HasUnitModulusAndUniformAngle) {
  std::vector<std::complex<float>> row(500'000);
  fill_phasor(stream_of(3), 0, 0, row);
  std::vector<double> turns;
  for (const std::complex<float> z : row) {
    ASSERT_NEAR(std::abs(std::complex<double>(z)), 1, 2.5e-7);
    turns.push_back(std::arg(std::complex<double>(z)) / (2 * std::numbers::pi) + 0.5);
  }
  EXPECT_GT(kolmogorov_smirnov_p_value(turns, [](double t) { return t; }), false_alarm);
  for (const std::size_t lag : {1, 16, 32, 48, 64}) {
    expect_uncorrelated(
        row.size() - lag, [&](std::size_t i) { return 2 * row[i].real() * row[i + lag].real(); }, "real parts");
    expect_uncorrelated(
        row.size() - lag, [&](std::size_t i) { return 2 * row[i].real() * row[i + lag].imag(); }, "both parts");
  }
}

TEST(RandomSequence, UniformIsUniformInTheOpenInterval) {
  RandomSequence random(stream_of(4));
  std::vector<double> samples(500'000);
  for (double& u : samples) {
    u = random.uniform();
    ASSERT_GT(u, 0);
    ASSERT_LT(u, 1);
  }
  EXPECT_GT(kolmogorov_smirnov_p_value(samples, [](double u) { return u; }), false_alarm);
}

TEST(RandomSequence, NormalIsStandardNormal) {
  RandomSequence random(stream_of(5));
  std::vector<double> samples(500'000);
  for (double& x : samples) {
    x = random.normal();
  }
  expect_normal_moments(samples);
  EXPECT_GT(kolmogorov_smirnov_p_value(samples, normal_cdf), false_alarm);
}

TEST(RandomSequence, BelowIsUniform) {
  constexpr int n = 200'000;
  RandomSequence random(stream_of(6));
  for (const std::uint64_t bound : {2, 3, 7, 10, 1000}) {
    std::vector<double> counts(bound);
    for (int i = 0; i < n; ++i) {
      const std::uint64_t k = random.below(bound);
      ASSERT_LT(k, bound);
      ++counts[k];
    }
    EXPECT_GT(chi_square_p_value(counts, std::vector<double>(bound, n / static_cast<double>(bound))), false_alarm)
        << bound;
  }
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(random.below(1), 0U);
  }
  EXPECT_THROW(random.below(0), std::invalid_argument);
}

TEST(RandomSequence, BelowIsUnbiasedForHugeBounds) {
  // Without refusals, a bound of 3/4 of 2^64 would give a third of the values twice the probability of the others.
  constexpr int n = 100'000;
  constexpr std::uint64_t quarter = std::uint64_t{1} << 62U;
  RandomSequence random(stream_of(7));
  std::vector<double> by_third(3);
  std::vector<double> by_remainder(3);
  for (int i = 0; i < n; ++i) {
    const std::uint64_t k = random.below(3 * quarter);
    ASSERT_LT(k, 3 * quarter);
    ++by_third[k / quarter];
    ++by_remainder[k % 3];
  }
  EXPECT_GT(chi_square_p_value(by_third, std::vector<double>(3, n / 3.0)), false_alarm);
  EXPECT_GT(chi_square_p_value(by_remainder, std::vector<double>(3, n / 3.0)), false_alarm);
}

/// χ² test of n Poisson numbers against the exact probabilities exp(k log λ − λ − log k!), neighbors joined until a bin
/// expects 1 % of the numbers.
double poisson_p_value(double mean, int n, RandomSequence random) {
  const double reach = 12 * std::sqrt(mean) + 30;
  const auto first = static_cast<std::int64_t>(std::max(0.0, mean - reach));
  const auto size = static_cast<std::size_t>(mean + reach) - static_cast<std::size_t>(first) + 1;
  std::vector<double> counts(size);
  for (int i = 0; i < n; ++i) {
    ++counts.at(static_cast<std::size_t>(random.poisson(mean) - first));
  }
  std::vector<double> bins{0};
  std::vector<double> expected{0};
  const long double log_mean = std::log(static_cast<long double>(mean));
  double left = n;  // expected count from here on
  for (std::size_t i = 0; i < size; ++i) {
    if (expected.back() >= 0.01 * n && left >= 20) {
      bins.push_back(0);
      expected.push_back(0);
    }
    const auto k = static_cast<long double>(first + static_cast<std::int64_t>(i));
    const auto probability = static_cast<double>(std::exp(k * log_mean - mean - std::lgamma(k + 1)));
    bins.back() += counts[i];
    expected.back() += n * probability;
    left -= n * probability;
  }
  return chi_square_p_value(bins, expected);
}

TEST(Poisson, HasTheExactLaw) {
  std::uint64_t seed = 100;
  for (const double mean : {0.1, 1.0, 5.0, 9.99, 10.0, 12.5, 30.0, 1000.0, 1e6}) {
    EXPECT_GT(poisson_p_value(mean, 200'000, RandomSequence(stream_of(seed++))), false_alarm) << "mean " << mean;
  }
}

TEST(Poisson, TheTestTellsNeighboringMeansApart) {
  // The same test must reject the numbers of another mean, or it says nothing.
  RandomSequence random(stream_of(200));
  std::vector<double> counts(2);
  for (int i = 0; i < 200'000; ++i) {
    ++counts[random.poisson(1.05) == 0 ? 0 : 1];
  }
  const double zero = std::exp(-1.0);
  EXPECT_LT(chi_square_p_value(counts, std::vector<double>{200'000 * zero, 200'000 * (1 - zero)}), false_alarm);
}

TEST(Poisson, HugeMeansAreNormal) {
  // Skewness 1 / sqrt(mean) <= 1e-6 is far below what these numbers of samples can tell.
  constexpr int n = 100'000;
  for (const double mean : {1e12, 1e15}) {
    RandomSequence random(stream_of(300));
    std::vector<double> samples;
    for (int i = 0; i < n; ++i) {
      const std::int64_t k = random.poisson(mean);
      samples.push_back((static_cast<double>(k) - mean) / std::sqrt(mean));
    }
    expect_normal_moments(samples);
    EXPECT_GT(kolmogorov_smirnov_p_value(samples, normal_cdf), false_alarm) << "mean " << mean;
  }
}

TEST(Poisson, MeanZeroIsZero) {
  RandomSequence random(stream_of(400));
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(random.poisson(0), 0);
  }
}

TEST(Poisson, ImpossibleMeansAreRefused) {
  RandomSequence random(stream_of(500));
  for (const double mean :
       {-1.0, -1e-300, 1.1e15, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THAT([&] { random.poisson(mean); },
                testing::ThrowsMessage<std::invalid_argument>(testing::HasSubstr("expected a number in [0, 1e15]")));
  }
}

// The p-values themselves, against tables: χ² quantiles of 1 %, and the Kolmogorov distribution at 1.3581.
TEST(Statistics, PValuesAreThoseOfTheTables) {
  EXPECT_NEAR(chi_square_p_value(6.634897, 1), 0.01, 1e-8);
  EXPECT_NEAR(chi_square_p_value(23.209251, 10), 0.01, 1e-8);
  EXPECT_NEAR(chi_square_p_value(135.806723, 100), 0.01, 1e-8);
  EXPECT_NEAR(chi_square_p_value(0.554298, 5), 0.99, 1e-7);
  EXPECT_NEAR(normal_p_value(1.959964), 0.05, 1e-7);
  std::vector<double> uniform;
  for (int i = 0; i < 10'000; ++i) {
    uniform.push_back((i + 0.5) / 10'000 + 0.013581);
  }
  EXPECT_NEAR(kolmogorov_smirnov_p_value(uniform, [](double u) { return u; }), 0.05, 2e-3);
}

}  // namespace textonbench::random_distribution_test
