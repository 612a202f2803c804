#include "experiments/metrics/replicates.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "methods/base/random.h"

namespace textonbench::replicates_test {

constexpr int entries = 50, count = 256;

/// Gaussian replicates of deviation 0.1 about 3, the first entry `shift` deviations off.
Replicates gaussian(std::uint64_t seed, double shift) {
  return draw_replicates(count, [=](int i) {
    std::vector<float> replicate(entries);
    fill_normal(Stream(Seed{seed}), static_cast<std::uint64_t>(i), 0, replicate);
    for (float& value : replicate) value = 3 + 0.1F * value;
    replicate.front() += static_cast<float>(0.1 * shift);
    return replicate;
  });
}

TEST(StandardErrorLimit, IsStudentsQuantile) {
  // Quantiles of level 1 − 0.01 / (2 m), the first and third of the normal law.
  EXPECT_NEAR(standard_error_limit(1, 1'000'000), 2.575829, 1e-4);
  EXPECT_NEAR(standard_error_limit(1, 256), 2.595247, 1e-4);
  EXPECT_NEAR(standard_error_limit(10'000, 1'000'000), 4.891638, 1e-4);
  EXPECT_NEAR(standard_error_limit(10'000, 256), 5.013773, 1e-3);
}

TEST(LargestDeviation, IsAboveOneWithProbabilityOnePerCent) {
  const std::vector<double> expected(entries, 3.0);
  int alarms = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) alarms += largest_deviation(gaussian(seed, 0), expected) > 1;
  // Binomial(400, 0.01) exceeds 12 with probability 3e-4, and is 0 with probability 2 %.
  EXPECT_LE(alarms, 12);
  EXPECT_GE(alarms, 1);
}

TEST(LargestDeviation, SeesOneEntryHalfADeviationOff) {
  // 0.5 √256 = 8 standard errors against a limit near 3.8.
  EXPECT_GT(largest_deviation(gaussian(1, 0.5), std::vector<double>(entries, 3.0)), 1.5);
}

TEST(LargestDeviation, OfConstantsIsZeroOrInfinite) {
  const Replicates constant(4, std::vector<float>{1, 2});
  EXPECT_EQ(largest_deviation(constant, std::vector{1.0, 2.0}), 0);
  EXPECT_TRUE(std::isinf(largest_deviation(constant, std::vector{1.0, 2.5})));
  EXPECT_THROW(largest_deviation(constant, std::vector{1.0}), std::invalid_argument);
  EXPECT_THROW(largest_deviation({{1.0F}}, std::vector{1.0}), std::invalid_argument);
}

}  // namespace textonbench::replicates_test
