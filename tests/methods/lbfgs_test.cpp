#include "methods/spot/lbfgs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace textonbench::lbfgs_test {

double rosenbrock(std::span<const double> x, std::span<double> gradient) {
  const double bend = x[1] - x[0] * x[0];
  gradient[0] = -2 * (1 - x[0]) - 400 * x[0] * bend;
  gradient[1] = 200 * bend;
  return (1 - x[0]) * (1 - x[0]) + 100 * bend * bend;
}

TEST(Lbfgs, FindsTheMinimumOfRosenbrocksFunction) {
  std::vector<double> x = {-1.2, 1};
  const LbfgsSummary summary =
      minimize_lbfgs(rosenbrock, {.evaluations = 200, .first_step = 1e-3, .tolerance = 1e-16}, x);
  EXPECT_NEAR(x[0], 1, 1e-5);
  EXPECT_NEAR(x[1], 1, 1e-5);
  EXPECT_LT(summary.evaluations, 100);
  EXPECT_NE(summary.reason, "evaluations");
}

TEST(Lbfgs, SolvesAQuadraticOfAFewEigenvaluesInAsManySteps) {
  const std::vector<double> curvature = {1, 1, 4, 4, 9, 9};
  std::vector<double> x = {1, -2, 3, -1, 2, 1};
  const auto quadratic = [&](std::span<const double> at, std::span<double> gradient) {
    double value = 0;
    for (std::size_t i = 0; i < at.size(); ++i) {
      gradient[i] = curvature[i] * at[i];
      value += 0.5 * curvature[i] * at[i] * at[i];
    }
    return value;
  };
  const LbfgsSummary summary = minimize_lbfgs(quadratic, {.evaluations = 40, .first_step = 0.2, .tolerance = 1e-14}, x);
  EXPECT_LT(summary.value, 1e-12);
}

TEST(Lbfgs, KeepsToItsBudgetAndReturnsTheLowestPoint) {
  for (const int evaluations : {1, 2, 7, 20}) {
    std::vector<double> x = {-1.2, 1};
    int calls = 0;
    const auto counted = [&](std::span<const double> at, std::span<double> gradient) {
      ++calls;
      return rosenbrock(at, gradient);
    };
    // A first step so long that the line search must shorten it.
    const LbfgsSummary summary = minimize_lbfgs(counted, {.evaluations = evaluations, .first_step = 1}, x);
    EXPECT_EQ(calls, evaluations);
    EXPECT_EQ(summary.evaluations, evaluations);
    EXPECT_EQ(summary.reason, "evaluations");
    ASSERT_EQ(summary.history.size(), static_cast<std::size_t>(evaluations));
    EXPECT_TRUE(std::ranges::is_sorted(summary.history, std::greater<>()));
    std::vector<double> gradient(2);
    EXPECT_EQ(rosenbrock(x, gradient), summary.value);
    EXPECT_EQ(gradient, summary.gradient);
    EXPECT_EQ(summary.value, summary.history.back());
  }
}

TEST(Lbfgs, StopsWhereNothingDescends) {
  std::vector<double> x = {0, 0};
  const auto flat = [](std::span<const double>, std::span<double> gradient) {
    std::ranges::fill(gradient, 0.0);
    return 1.0;
  };
  const LbfgsSummary summary = minimize_lbfgs(flat, {}, x);
  EXPECT_EQ(summary.reason, "no descent");
  EXPECT_LE(summary.evaluations, 2);
}

}  // namespace textonbench::lbfgs_test
