#include "experiments/statistics/hypothesis_tests.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "experiments/statistics/student.h"

namespace textonbench::hypothesis_tests_test {

using testing::DoubleNear;
using testing::ElementsAre;

TEST(Wilcoxon, SmallCasesByHand) {
  // All of one sign: 2 of the 2^n sign patterns are as extreme.
  EXPECT_DOUBLE_EQ(wilcoxon_signed_rank(std::vector<double>{1, 2, 3, 4, 5}), 2.0 / 32);
  // Negative ranks 1: the sums 0 and 1 have a pattern each, on both sides.
  EXPECT_DOUBLE_EQ(wilcoxon_signed_rank(std::vector<double>{-1, 2, 3, 4, 5}), 4.0 / 32);
  // Negative ranks 1 + 2 = 3: sums 0, 1, 2, 3 have 1, 1, 1, 2 patterns.
  EXPECT_DOUBLE_EQ(wilcoxon_signed_rank(std::vector<double>{-1, -2, 3, 4, 5, 6}), 10.0 / 64);
  EXPECT_DOUBLE_EQ(wilcoxon_signed_rank(std::vector<double>{1, -1}), 1);
}

TEST(Wilcoxon, TiesShareRanksAndZerosAreLeftOut) {
  // Ranks 1.5, 1.5, 3 with the first negative: the sums 0 and 1.5 have 1 and 2 patterns of 8.
  EXPECT_DOUBLE_EQ(wilcoxon_signed_rank(std::vector<double>{-1, 0, 1, 0, 2}), 6.0 / 8);
  EXPECT_EQ(wilcoxon_signed_rank(std::vector<double>{0, 0}), 1);
  EXPECT_EQ(wilcoxon_signed_rank({}), 1);
  EXPECT_THROW(wilcoxon_signed_rank(std::vector<double>{std::nan("")}), std::invalid_argument);
}

TEST(Wilcoxon, ApproximationContinuesTheExactLaw) {
  std::vector<double> differences;
  for (int i = 1; i <= 25; ++i) differences.push_back(i % 3 == 0 ? -i : i);
  const double exact = wilcoxon_signed_rank(differences);
  // Rank sum of the negative ones 3 + … + 24 = 108, mean 162.5, variance 1381.25.
  EXPECT_NEAR(exact, std::erfc((162.5 - 108 - 0.5) / std::sqrt(2 * 1381.25)), 0.003);
  differences.push_back(26);
  // 26 differences, mean 175.5, variance 1550.25.
  EXPECT_NEAR(wilcoxon_signed_rank(differences), std::erfc((175.5 - 108 - 0.5) / std::sqrt(2 * 1550.25)), 1e-12);
}

TEST(Holm, ByHand) {
  EXPECT_THAT(
      holm(std::vector<double>{0.01, 0.04, 0.03, 0.005}),
      ElementsAre(DoubleNear(0.03, 1e-15), DoubleNear(0.06, 1e-15), DoubleNear(0.06, 1e-15), DoubleNear(0.02, 1e-15)));
  EXPECT_THAT(holm(std::vector<double>{0.5, 0.9}), ElementsAre(1.0, 1.0));
  EXPECT_TRUE(holm({}).empty());
}

TEST(Student, AgreesWithTables) {
  EXPECT_NEAR(student_quantile(0.975, 1), 12.7062047, 1e-6);
  EXPECT_NEAR(student_quantile(0.975, 2), 4.30265273, 1e-7);
  EXPECT_NEAR(student_quantile(0.975, 12), 2.17881283, 1e-7);
  EXPECT_NEAR(student_quantile(0.995, 30), 2.74999565, 1e-7);
  EXPECT_NEAR(student_quantile(0.05, 5), -2.01504837, 1e-7);
  EXPECT_NEAR(student_cdf(student_quantile(0.9, 7), 7), 0.9, 1e-12);
  EXPECT_DOUBLE_EQ(student_cdf(0, 4), 0.5);
  EXPECT_THROW(student_quantile(1, 3), std::invalid_argument);
  EXPECT_THROW(student_cdf(1, 0), std::invalid_argument);
}

}  // namespace textonbench::hypothesis_tests_test
