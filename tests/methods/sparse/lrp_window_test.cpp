// The window of local random-phase noise: constants of the paper, and what its printed series is.
#include "methods/sparse/lrp_window.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace textonbench {
namespace {

TEST(LrpWindow, IsTheKaiserBesselWindowOfOrderThree) {
  for (int i = 0; i <= 150; ++i) {
    const double y = 0.01 * i;
    const double z = 3 * std::numbers::pi * std::sqrt(1 - std::pow(y / 1.5, 2));
    const double bessel = std::cyl_bessel_i(3.0, z) / std::cyl_bessel_i(3.0, 3 * std::numbers::pi);
    EXPECT_NEAR(lrp_window(LrpWindow::bessel, y), bessel, 1e-13) << y;
  }
  EXPECT_EQ(lrp_window(LrpWindow::bessel, 0), 1);
  EXPECT_EQ(lrp_window(LrpWindow::bessel, 1.5), 0);
  EXPECT_EQ(lrp_window(LrpWindow::bessel, -1.6), 0);
}

TEST(LrpWindow, PrintedSeriesIsFiveTermsAsPrinted) {
  const auto series = [](double z) {
    double sum = 0;
    for (int m = 0; m <= 4; ++m) sum += std::pow(z / 2, 2 * m + 3) / (std::tgamma(m + 1) * std::tgamma(m + 3));
    return sum;
  };
  for (int i = 0; i <= 150; ++i) {
    const double y = 0.01 * i;
    const double z = 3 * std::numbers::pi * std::sqrt(1 - std::pow(y / 1.5, 2));
    EXPECT_NEAR(lrp_window(LrpWindow::printed, y), series(z) / series(3 * std::numbers::pi), 1e-13) << y;
  }
}

TEST(LrpWindow, PolynomialIsTheWindow) {
  for (const LrpWindow window : {LrpWindow::bessel, LrpWindow::printed}) {
    const auto& p = lrp_window_polynomial(window);
    for (int i = 0; i <= 1500; ++i) {
      const double y = 0.001 * i;
      const auto t = static_cast<float>(std::max(0.0, 1 - y * y / 2.25));
      float sum = 0;
      for (int m = lrp_window_terms - 1; m >= 0; --m) sum = sum * t + p[static_cast<std::size_t>(m)];
      ASSERT_NEAR(t * std::sqrt(t) * sum, lrp_window(window, y), 3e-7) << y;
    }
  }
}

/// The paper's 0.1126 is the constant of I_3; its printed formula would give 0.118.
TEST(LrpWindow, ConstantOfThePaperIsThatOfTheBesselFunction) {
  EXPECT_NEAR(lrp_window_moments(LrpWindow::bessel).radial_energy, 0.11259, 5e-6);
  EXPECT_NEAR(lrp_window_moments(LrpWindow::printed).radial_energy, 0.1179, 5e-5);
  double sum = 0;  // Simpson's rule, apart from the library's quadrature
  constexpr int n = 1000;
  for (int i = 0; i <= n; ++i) {
    const double r = 1.5 * i / n;
    sum += (i == 0 || i == n ? 1 : i % 2 == 1 ? 4 : 2) * r * std::pow(lrp_window(LrpWindow::bessel, r), 2);
  }
  EXPECT_NEAR(sum * 1.5 / n / 3, lrp_window_moments(LrpWindow::bessel).radial_energy, 1e-6);
}

TEST(LrpWindow, ThreeQuartersOfItsEnergyAreWithinTheRadius) {
  EXPECT_NEAR(lrp_window_moments(LrpWindow::bessel).energy_radius, 0.281, 5e-4);
  EXPECT_NEAR(lrp_window_moments(LrpWindow::printed).energy_radius, 0.278, 5e-4);
}

/// "The envelope varies less than 5 %" holds for the sum of the windows, not for that of their squares, which is the
/// variance of a noise of random phases.
TEST(LrpWindow, SumIsNearlyConstantAndSumOfSquaresIsNot) {
  double least = 9, most = 0, mean = 0, least_square = 9, most_square = 0, mean_square = 0;
  constexpr int n = 64;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      double sum = 0, squares = 0;
      int within = 0;
      for (int dy = -2; dy <= 2; ++dy) {
        for (int dx = -2; dx <= 2; ++dx) {
          const double w =
              lrp_window(LrpWindow::bessel, std::hypot((i + 0.5) / n - 0.5 - dx, (j + 0.5) / n - 0.5 - dy));
          within += w > 0 ? 1 : 0;
          sum += w;
          squares += w * w;
        }
      }
      EXPECT_LE(within, 9);
      least = std::min(least, sum);
      most = std::max(most, sum);
      mean += sum / (n * n);
      least_square = std::min(least_square, squares);
      most_square = std::max(most_square, squares);
      mean_square += squares / (n * n);
    }
  }
  EXPECT_NEAR(mean, 1.3304, 1e-3);
  EXPECT_NEAR((most - least) / mean, 0.0377, 5e-4);
  EXPECT_NEAR(mean_square, 2 * std::numbers::pi * lrp_window_moments(LrpWindow::bessel).radial_energy, 1e-5);
  EXPECT_NEAR(most_square / least_square, 2.40, 0.01);
}

}  // namespace
}  // namespace textonbench
