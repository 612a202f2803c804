// Averaged periodograms against direct Fourier sums.
#include "methods/base/welch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "tests/texture.h"

namespace textonbench {
namespace {

TEST(Welch, SideIsThePowerOfTwoStrictlyBelow) {
  EXPECT_EQ(welch_side({256, 300}), 128);
  EXPECT_EQ(welch_side({257, 300}), 256);
  EXPECT_EQ(welch_side({600, 33}), 32);
  EXPECT_EQ(welch_side({600, 32}), 16);
}

TEST(Welch, BlocksAreSpreadFromBorderToBorder) {
  const WelchSpectrum spectrum(test_texture({50, 32}, 1), {.side = 16, .overlap = 0.5});
  std::vector<Pixel> expected;
  for (const int y : {0, 8, 16}) {
    for (const int x : {0, 6, 13, 20, 27, 34}) expected.push_back({x, y});
  }
  EXPECT_EQ(spectrum.blocks(), expected);
  EXPECT_EQ(WelchSpectrum(test_texture({32, 32}, 1), {.side = 32}).blocks().size(), 1U);
}

TEST(Welch, IsTheMeanOfPeriodograms) {
  const Image u = test_texture({21, 17}, 3);
  for (const Taper taper : {Taper::none, Taper::hann}) {
    constexpr int side = 8;
    const WelchSpectrum spectrum(u, {.side = side, .overlap = 0.3, .taper = taper});
    const auto weight = [&](int i) {
      return taper == Taper::none ? 1 : std::pow(std::sin(std::numbers::pi * (i + 0.5) / side), 2);
    };
    double squares = 0;
    for (int i = 0; i < side; ++i) squares += std::pow(weight(i), 2);
    for (int ky = 0; ky < side; ++ky) {
      for (int kx = 0; kx <= side / 2; ++kx) {
        Eigen::MatrixXcd expected = Eigen::MatrixXcd::Zero(3, 3);
        for (const Pixel& corner : spectrum.blocks()) {
          Eigen::VectorXcd z = Eigen::VectorXcd::Zero(3);
          for (int c = 0; c < 3; ++c) {
            for (int y = 0; y < side; ++y) {
              for (int x = 0; x < side; ++x) {
                const double value = static_cast<double>(u.at(c, corner.x + x, corner.y + y)) -
                                     spectrum.mean()[static_cast<std::size_t>(c)];
                z[c] +=
                    weight(x) * weight(y) * value * std::polar(1.0, -2 * std::numbers::pi * (kx * x + ky * y) / side);
              }
            }
          }
          expected += z * z.adjoint() / (squares * squares * static_cast<double>(spectrum.blocks().size()));
        }
        EXPECT_LT((spectrum.at(kx, ky) - expected).norm(), 1e-5 * (expected.norm() + 1e-3));
        EXPECT_NEAR(spectrum.power(kx, ky), expected.trace().real(), 1e-5 * (expected.norm() + 1e-3));
      }
    }
  }
}

TEST(Welch, TellsWhatIsWrong) {
  const Image u = test_texture({40, 30}, 1);
  for (const int side : {32, 12, 4}) EXPECT_THROW(WelchSpectrum(u, {.side = side}), std::invalid_argument) << side;
  for (const double overlap : {-0.1, 1.0, std::nan("")}) {
    EXPECT_THROW(WelchSpectrum(u, {.overlap = overlap}), std::invalid_argument) << overlap;
  }
  EXPECT_THROW(WelchSpectrum(test_texture({600, 600}, 1), {.side = 8, .overlap = 0.99}), std::invalid_argument);
}

}  // namespace
}  // namespace textonbench
