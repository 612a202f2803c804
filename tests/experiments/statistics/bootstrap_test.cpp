#include "experiments/statistics/bootstrap.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include "tests/sanitizer.h"

namespace textonbench::bootstrap_test {

using Law = std::function<double(RandomSequence&)>;

double gaussian(RandomSequence& random) { return random.normal(); }
/// Exponential less its mean: variance 1, skewness 2.
double skewed(RandomSequence& random) { return -std::log(random.uniform()) - 1; }

struct Design {
  std::size_t exemplars, seeds;
  double between, within;
};

/// Share of 1000 synthetic sets of mean zero whose 95 % interval holds zero.
double coverage(const Design& design, const Law& law) {
  constexpr int trials = 1000;
  int covered = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const Seed seed = derive(Seed{2024}, static_cast<std::uint64_t>(trial));
    RandomSequence random(Stream(seed).child("data"));
    Levels levels(design.exemplars);
    for (std::vector<double>& numbers : levels) {
      const double effect = design.between * law(random);
      for (std::size_t k = 0; k < design.seeds; ++k) numbers.push_back(effect + design.within * law(random));
    }
    const Estimate estimate = bootstrap_mean(levels, 0.95, 400, seed);
    covered += estimate.low <= 0 && 0 <= estimate.high ? 1 : 0;
  }
  return static_cast<double>(covered) / trials;
}

/// The numbers of bootstrap.h: experiments_tests --gtest_output=json:FILE writes them.
void record(const Design& design, const char* law, double share) {
  testing::Test::RecordProperty(
      fmt::format("{}_{}x{}_{}_{}", law, design.exemplars, design.seeds, design.between, design.within),
      fmt::format("{:.1f} %", 100 * share));
}

TEST(Bootstrap, NinetyFivePercentIntervalCoversAsOften) {
  if (sanitized) GTEST_SKIP() << "takes long in a build with a sanitizer";
  for (const Design& design : {Design{13, 4, 1, 0.5}, Design{13, 4, 0.2, 2}, Design{13, 1, 1, 1}, Design{6, 4, 1, 0.5},
                               Design{3, 4, 1, 0.5}, Design{1, 8, 0, 1}}) {
    const double share = coverage(design, gaussian);
    record(design, "gaussian", share);
    EXPECT_GE(share, 0.93) << design.exemplars << " x " << design.seeds << ", within " << design.within;
    EXPECT_LE(share, 0.97) << design.exemplars << " x " << design.seeds << ", within " << design.within;
  }
}

TEST(Bootstrap, CoversSkewedDataToo) {
  if (sanitized) GTEST_SKIP() << "takes long in a build with a sanitizer";
  for (const Design& design : {Design{13, 4, 1, 0.5}, Design{13, 4, 0.2, 2}, Design{20, 10, 1, 1}}) {
    const double share = coverage(design, skewed);
    record(design, "skewed", share);
    EXPECT_GE(share, 0.93) << design.exemplars << " x " << design.seeds << ", within " << design.within;
    EXPECT_LE(share, 0.97) << design.exemplars << " x " << design.seeds << ", within " << design.within;
  }
}

TEST(Bootstrap, TwoExemplarsByHand) {
  // Exemplar means 2 and 6, D = 4, s = sqrt((4 + 4) / 2) = 2, and t(0.975, 1 degree) = tan(0.475 π) = 12.7062.
  const TestedMean tested = test_mean({{1, 3}, {5, 6, 7}}, 0.95, 1000, Seed{1});
  EXPECT_DOUBLE_EQ(tested.estimate.value, 4);
  EXPECT_NEAR(tested.estimate.low, 4 - 2 * 12.7062047, 1e-5);
  EXPECT_NEAR(tested.estimate.high, 4 + 2 * 12.7062047, 1e-5);
  // P(|T| > 2) with one degree of freedom: 1 − 2 atan(2) / π.
  EXPECT_NEAR(tested.p_value, 1 - 2 * std::atan(2.0) / std::acos(-1.0), 1e-12);
}

TEST(Bootstrap, FourExemplarsAgainstTheEnumeratedReplicates) {
  // All 4⁴ equally likely replicates of {0, 1, 3, 8}, without seeds to draw.
  const std::vector<double> x{0, 1, 3, 8};
  const double s = std::sqrt(38.0 / 12);
  std::vector<double> t;
  for (int code = 0; code < 256; ++code) {
    double sum = 0, squares = 0;
    for (int i = 0, rest = code; i < 4; ++i, rest /= 4) {
      sum += x[static_cast<std::size_t>(rest % 4)];
      squares += x[static_cast<std::size_t>(rest % 4)] * x[static_cast<std::size_t>(rest % 4)];
    }
    const double variance = (squares - sum * sum / 4) / 12;
    t.push_back(variance > 1e-12 ? (sum / 4 - 3) / std::sqrt(variance)
                                 : std::copysign(std::numeric_limits<double>::infinity(), sum / 4 - 3));
  }
  std::sort(t.begin(), t.end());
  // At 80 % no quantile falls on a replicate without spread; 25.5 and 229.5 of 256 are the tails.
  const Estimate estimate = bootstrap_mean({{0}, {1}, {3}, {8}}, 0.8, 100000, Seed{3});
  EXPECT_NEAR(estimate.low, 3 - s * t[230], 0.2);
  EXPECT_NEAR(estimate.high, 3 - s * t[25], 0.2);
}

TEST(Bootstrap, DegenerateData) {
  const Estimate single = bootstrap_mean({{5}}, 0.95, 1000, Seed{1});
  EXPECT_EQ(single.value, 5);
  EXPECT_EQ(single.low, -std::numeric_limits<double>::infinity());
  EXPECT_EQ(single.high, std::numeric_limits<double>::infinity());

  const TestedMean equal = test_mean({{0.1, 0.1, 0.1}, {0.1}, {0.1}, {0.1}, {0.1}}, 0.95, 1000, Seed{1});
  EXPECT_NEAR(equal.estimate.value, 0.1, 1e-15);
  EXPECT_EQ(equal.estimate.low, equal.estimate.high);
  EXPECT_EQ(equal.p_value, 0);
  EXPECT_EQ(test_mean({{0}, {0}, {0}}, 0.95, 1000, Seed{1}).p_value, 1);

  // One that differs among ties: a third of the replicates has no spread, and Student's t takes over.
  Levels ties(13, {0.0});
  ties.front() = {13};
  const Estimate estimate = bootstrap_mean(ties, 0.95, 1000, Seed{1});
  EXPECT_NEAR(estimate.low, 1 - 2.1788128, 1e-6);
  EXPECT_NEAR(estimate.high, 1 + 2.1788128, 1e-6);
}

TEST(Bootstrap, IsDeterministicAndItsPValueAgreesWithTheInterval) {
  RandomSequence random(Stream(Seed{11}));
  for (int trial = 0; trial < 50; ++trial) {
    Levels levels(8);
    for (std::vector<double>& numbers : levels) numbers = {random.normal() + 0.8, random.normal() + 0.8};
    const TestedMean tested = test_mean(levels, 0.95, 2000, Seed{4});
    const TestedMean again = test_mean(levels, 0.95, 2000, Seed{4});
    EXPECT_EQ(tested.estimate.low, again.estimate.low);
    EXPECT_EQ(tested.estimate.high, again.estimate.high);
    const bool excludes_zero = tested.estimate.low > 0 || tested.estimate.high < 0;
    if (std::fabs(tested.p_value - 0.05) > 0.002) {
      EXPECT_EQ(tested.p_value < 0.05, excludes_zero);
    }
  }
}

TEST(Bootstrap, RefusesWhatItCannotAverage) {
  EXPECT_THROW(bootstrap_mean({}, 0.95, 1000, Seed{1}), std::invalid_argument);
  EXPECT_THROW(bootstrap_mean({{1}, {}}, 0.95, 1000, Seed{1}), std::invalid_argument);
  EXPECT_THROW(bootstrap_mean({{1, std::nan("")}}, 0.95, 1000, Seed{1}), std::invalid_argument);
  EXPECT_THROW(bootstrap_mean({{1}}, 1, 1000, Seed{1}), std::invalid_argument);
  EXPECT_THROW(bootstrap_mean({{1}}, 0.95, 10, Seed{1}), std::invalid_argument);
}

}  // namespace textonbench::bootstrap_test
