#include "methods/spot/spline_spectrum.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "methods/base/bspline.h"
#include "methods/spot/texton_error.h"
#include "tests/texture.h"

namespace textonbench::spline_spectrum_test {

SplineTexton small_texton(int order, int channels, std::uint64_t kernels) {
  SplineTexton texton{.coefficients = {}, .order = order};
  texton.coefficients.mean.assign(static_cast<std::size_t>(channels), 0.5);
  texton.coefficients.support_pixels = 30;
  texton.support_area = (6 + order) * (5 + order);
  for (std::uint64_t k = 0; k < kernels; ++k) {
    Image& alpha = texton.coefficients.kernels.emplace_back(Extent{6, 5}, channels);
    for (int c = 0; c < channels; ++c) {
      for (int y = 0; y < 5; ++y) {
        fill_normal(Stream(Seed{k}).child(static_cast<std::uint64_t>(c)), static_cast<std::uint64_t>(y), 0,
                    alpha.row(c, y));
      }
    }
  }
  return texton;
}

/// h(x, y) as the sum that defines it.
double kernel_at(const SplineTexton& texton, const Image& alpha, int channel, double x, double y) {
  double sum = 0;
  for (int j = 0; j < alpha.height(); ++j) {
    for (int i = 0; i < alpha.width(); ++i) {
      sum += static_cast<double>(alpha.at(channel, i, j)) * bspline(texton.order, x - i) * bspline(texton.order, y - j);
    }
  }
  return sum;
}

/// The covariance of the noise is ∫ h(y) h(y + v) dy; here by Gauss-Legendre quadrature of three points in every
/// quarter of a cell, exact for polynomials of degree 5 and so for orders up to 2.
TEST(SplineSpectrum, IsTheTransformOfTheIntegralThatTheCovarianceIs) {
  for (const int order : {0, 1, 2}) {
    const SplineTexton texton = small_texton(order, 3, 2);
    const Extent grid{18, 16};
    const CrossSpectrum spectrum = spline_spectrum(texton, grid);
    const Autocovariance gamma = autocovariance(spectrum);
    const double nodes[] = {0.5 - std::sqrt(0.15), 0.5, 0.5 + std::sqrt(0.15)};
    const double weights[] = {5 / 18.0, 8 / 18.0, 5 / 18.0};
    for (const auto& [c, d, vx, vy] : {std::array{0, 0, 0, 0}, {1, 1, 1, 0}, {0, 2, 2, -3}, {2, 1, -1, 1}}) {
      double integral = 0;
      for (const Image& alpha : texton.coefficients.kernels) {
        for (int iy = -8; iy < 24; ++iy) {
          for (int ix = -8; ix < 28; ++ix) {
            for (int a = 0; a < 9; ++a) {
              const double x = (ix + nodes[a % 3]) / 2;
              const double y = (iy + nodes[a / 3]) / 2;
              integral += weights[a % 3] * weights[a / 3] / 4 * kernel_at(texton, alpha, c, x + vx, y + vy) *
                          kernel_at(texton, alpha, d, x, y);
            }
          }
        }
      }
      double constant = 0;  // autocovariance() leaves ξ = 0 out
      for (const Spectrum& factor : spectrum.factors) {
        constant += static_cast<double>(factor.at(c, 0, 0).real()) * static_cast<double>(factor.at(d, 0, 0).real()) /
                    static_cast<double>(grid.area());
      }
      EXPECT_NEAR(gamma.at(c, d, vx, vy) + constant, integral, 2e-5)
          << order << " " << c << d << " " << vx << " " << vy;
    }
  }
}

TEST(SplineSpectrum, OfOrderZeroIsThatOfTheTexton) {
  const SplineTexton texton = small_texton(0, 3, 2);
  const CrossSpectrum spline = spline_spectrum(texton, {9, 8});
  const CrossSpectrum plain = texton_spectrum(texton.coefficients, {9, 8});
  for (std::size_t k = 0; k < 2; ++k) {
    for (int c = 0; c < 3; ++c) {
      for (int ky = 0; ky < 8; ++ky) {
        for (int kx = 0; kx < 5; ++kx) {
          ASSERT_NEAR(std::abs(spline.factors[k].at(c, kx, ky) - plain.factors[k].at(c, kx, ky)), 0, 1e-5);
        }
      }
    }
  }
}

TEST(SplineSpectrum, GridsMayBeSmallerThanTheTexton) {
  const SplineTexton texton = small_texton(1, 1, 1);
  const CrossSpectrum coarse = spline_spectrum(texton, {4, 2});
  const CrossSpectrum fine = spline_spectrum(texton, {12, 10});
  EXPECT_NEAR(std::abs(coarse.factors[0].at(0, 1, 1) - fine.factors[0].at(0, 3, 5)), 0, 1e-5);
}

/// Ledger T03.
TEST(SplineSpectrum, LinearSplinesHaveAGainThatIsPositiveAndLeastAtTheCorner) {
  const Extent grid{64, 48};
  const SplineGain gain(1, grid);
  double least = 1;
  for (int ky = 0; ky < grid.height; ++ky) {
    for (int kx = 0; kx <= grid.width / 2; ++kx) {
      least = std::min(least, std::pow(gain.column(kx) * gain.row(ky), 2));
    }
  }
  EXPECT_NEAR(least, 1.0 / 9, 1e-14);
  EXPECT_NEAR(std::pow(gain.column(32) * gain.row(24), 2), least, 1e-15);
}

TEST(SplineSpectrum, RefusesOrdersThatDoNotExist) {
  EXPECT_THROW(spline_spectrum(small_texton(6, 1, 1), {8, 8}), std::invalid_argument);
  EXPECT_THROW(SplineGain(-1, {8, 8}), std::invalid_argument);
}

}  // namespace textonbench::spline_spectrum_test
