#include "experiments/statistics/crossing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace textonbench::crossing_test {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// y = (100 / x)^exponent, with a relative error.
std::vector<MeasuredPoint> power_law(double exponent, double relative_error) {
  std::vector<MeasuredPoint> points;
  for (const double x : {10.0, 30.0, 90.0, 400.0}) {
    const double y = std::pow(100 / x, exponent);
    points.push_back({x, y, relative_error * y});
  }
  return points;
}

TEST(Crossing, OfAPowerLawIsExact) {
  for (const double exponent : {0.5, 1.0, 2.0}) {
    const Estimate crossing = log_log_crossing(power_law(exponent, 0.01), 2);
    EXPECT_NEAR(crossing.value, 100 * std::pow(2, -1 / exponent), 1e-9);
    EXPECT_NEAR(crossing.high / crossing.value, std::exp(1.959964 * 0.01 / exponent), 1e-9);
    EXPECT_NEAR(crossing.value / crossing.low, std::exp(1.959964 * 0.01 / exponent), 1e-9);
  }
}

TEST(Crossing, OutsideThePointsIsZeroOrInfinite) {
  EXPECT_EQ(log_log_crossing(power_law(1, 0), 20).value, 0);
  EXPECT_EQ(log_log_crossing(power_law(1, 0), 0.1).value, infinity);
  const Estimate near_the_end = log_log_crossing(power_law(1, 0.5), 0.3);
  EXPECT_NEAR(near_the_end.value, 333.3333, 1e-3);
  EXPECT_EQ(near_the_end.high, infinity);
}

TEST(Crossing, CountsWhereTheCurveComesDownForGood) {
  const std::vector<MeasuredPoint> points{{1, 4, 0}, {2, 1, 0}, {4, 4, 0}, {16, 1, 0}, {32, 1.5, 0}};
  EXPECT_NEAR(log_log_crossing(points, 2).value, 8, 1e-12);
}

TEST(Crossing, RefusesWhatHasNone) {
  const std::vector<std::vector<MeasuredPoint>> bad{
      {}, {{1, 0, 0}}, {{0, 1, 0}}, {{2, 1, 0}, {1, 1, 0}}, {{1, 1, -1}}, {{1, infinity, 0}}};
  for (const auto& points : bad) EXPECT_THROW(log_log_crossing(points, 2), std::invalid_argument);
  EXPECT_THROW(log_log_crossing(power_law(1, 0), 0), std::invalid_argument);
}

}  // namespace textonbench::crossing_test
