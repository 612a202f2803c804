#include "methods/base/bspline.h"

#include <gmock/gmock.h>

#include <cmath>
#include <stdexcept>

namespace textonbench::bspline_test {

// The truncated-power formula β^n(x) = Σ_q (−1)^q C(n+1, q) (x + (n+1)/2 − q)₊^n / n!.
double by_truncated_powers(int order, double x) {
  long double sum = 0;
  long double binomial = 1;
  for (int q = 0; q <= order + 1; ++q) {
    const long double base = x + (order + 1) / 2.0L - q;
    if (base > 0) {
      sum += (q % 2 == 0 ? 1 : -1) * binomial * std::pow(base, static_cast<long double>(order));
    }
    binomial = binomial * (order + 1 - q) / (q + 1);
  }
  return static_cast<double>(sum / std::tgamma(order + 1.0L));
}

TEST(BsplineTest, IsTheSumOfTruncatedPowers) {
  for (int order = 1; order <= 11; ++order) {
    for (int step = -66; step <= 66; ++step) {
      const double x = step * 0.1 + 0.003;
      EXPECT_NEAR(bspline(order, x), by_truncated_powers(order, x), 1e-10) << order << " at " << x;
    }
  }
  EXPECT_EQ(bspline(0, -0.5), 1);
  EXPECT_EQ(bspline(0, 0.5), 0);
}

TEST(BsplineTest, TheTapsAreItsValuesAndSumToOne) {
  for (int order = 0; order <= max_bspline_order; ++order) {
    for (const double x : {-7.25, -3.0, -0.5, -0.25, 0.0, 0.3, 0.5, 0.75, 1.0, 2.5, 1e6 + 0.125}) {
      const BsplineTaps taps = bspline_taps(order, x);
      double sum = 0;
      for (int i = 0; i <= order; ++i) {
        const double weight = taps.weights[static_cast<std::size_t>(i)];
        sum += weight;
        const double distance = x - static_cast<double>(taps.first + i);
        EXPECT_NEAR(weight, bspline(order, distance), 1e-12) << "order " << order << " at " << x << ", tap " << i;
      }
      EXPECT_NEAR(sum, 1, 1e-12);
    }
  }
}

TEST(BsplineTest, TheDerivativeIsThatOfTheTaps) {
  const double h = 1e-6;
  for (int order = 1; order <= max_bspline_order; ++order) {
    for (const double x : {-2.3, 0.1, 0.49, 0.6, 1.8}) {
      const BsplineTaps taps = bspline_derivative_taps(order, x);
      EXPECT_EQ(taps.first, bspline_taps(order, x).first);
      for (int i = 0; i <= order; ++i) {
        const double distance = x - static_cast<double>(taps.first + i);
        const double slope = (bspline(order, distance + h) - bspline(order, distance - h)) / (2 * h);
        EXPECT_NEAR(taps.weights[static_cast<std::size_t>(i)], slope, 1e-8) << "order " << order << " at " << x;
      }
    }
  }
}

TEST(BsplineTest, TheAutocorrelationHasItsKnownFractions) {
  EXPECT_THAT(bspline_autocorrelation(0), testing::ElementsAre(testing::DoubleEq(1)));
  EXPECT_THAT(bspline_autocorrelation(1), testing::ElementsAre(testing::DoubleEq(2.0 / 3), testing::DoubleEq(1.0 / 6)));
  EXPECT_THAT(bspline_autocorrelation(3),
              testing::ElementsAre(testing::DoubleNear(151.0 / 315, 1e-15), testing::DoubleNear(397.0 / 1680, 1e-15),
                                   testing::DoubleNear(1.0 / 42, 1e-15), testing::DoubleNear(1.0 / 5040, 1e-15)));
}

TEST(BsplineTest, ThePowerIsLeastAtTheNyquistFrequency) {
  for (int order = 0; order <= max_bspline_order; ++order) {
    EXPECT_NEAR(bspline_power(order, 0), 1, 1e-12);
    for (int k = 0; k < 50; ++k) {
      EXPECT_GE(bspline_power(order, k / 100.0), bspline_power(order, 0.5)) << order;
    }
  }
  const double corner_1 = bspline_power(1, 0.5);
  const double corner_3 = bspline_power(3, 0.5);
  EXPECT_NEAR(corner_1, 1.0 / 3, 1e-15);
  EXPECT_NEAR(1 / corner_3, 18.53, 0.01);
}

TEST(BsplineTest, OrdersOutOfRangeAreRefused) {
  EXPECT_THROW(bspline(-1, 0), std::invalid_argument);
  EXPECT_THROW(bspline(12, 0), std::invalid_argument);
  EXPECT_THROW(bspline_taps(6, 0), std::invalid_argument);
  EXPECT_THROW(bspline_derivative_taps(0, 0), std::invalid_argument);
  EXPECT_THROW(bspline_autocorrelation(-1), std::invalid_argument);
}

}  // namespace textonbench::bspline_test
