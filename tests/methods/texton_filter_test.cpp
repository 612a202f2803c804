#include "methods/spot/texton_filter.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "methods/base/bspline.h"
#include "tests/texton.h"

namespace textonbench::texton_filter_test {

Image coefficients(Extent extent, int channels) { return test_texton(extent, channels, 1).kernels.front(); }

double kernel_sum(const Image& image, int channel) {
  double sum = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (const float v : image.row(channel, y)) sum += v;
  }
  return sum;
}

/// h at (x, y) as the sum that defines it.
double kernel_at(const Image& alpha, int channel, double x, double y) {
  double sum = 0;
  for (int j = 0; j < alpha.height(); ++j) {
    for (int i = 0; i < alpha.width(); ++i) sum += alpha.at(channel, i, j) * bspline(1, x - i) * bspline(1, y - j);
  }
  return sum;
}

Eigen::Matrix2d columns(double xu, double yu, double xv, double yv) {
  Eigen::Matrix2d footprint;
  footprint << xu, xv, yu, yv;
  return footprint;
}

TEST(MipChain, HasAZeroFrameAtEveryLevelWhateverTheSize) {
  for (const Extent extent : {Extent{1, 1}, Extent{9, 5}, Extent{8, 8}, Extent{31, 17}}) {
    const Image alpha = coefficients(extent, 3);
    const MipChain chain(alpha);
    ASSERT_EQ(chain.extent(chain.coarsest()), (Extent{1, 1}));
    for (int level = 0; level <= chain.coarsest(); ++level) {
      const auto [width, height] = chain.extent(level);
      EXPECT_GE(width << level, extent.width);
      for (int x = -1; x <= width; ++x) {
        EXPECT_EQ(chain.texel(level, x, -1).norm() + chain.texel(level, x, height).norm(), 0);
      }
      for (int y = -1; y <= height; ++y) {
        EXPECT_EQ(chain.texel(level, -1, y).norm() + chain.texel(level, width, y).norm(), 0);
      }
    }
  }
}

TEST(MipChain, EveryLevelHasTheSameIntegral) {
  const Image alpha = coefficients({13, 22}, 3);
  const MipChain chain(alpha);
  for (int level = 0; level <= chain.coarsest(); ++level) {
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    for (int y = 0; y < chain.extent(level).height; ++y) {
      for (int x = 0; x < chain.extent(level).width; ++x) sum += chain.texel(level, x, y).cast<double>();
    }
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(sum[c] * std::pow(4, level), kernel_sum(alpha, c), 1e-5) << level;
    }
    EXPECT_EQ(sum[3], 0);
  }
}

TEST(MipChain, LevelZeroIsTheKernelAndHigherLevelsAreSplinesOfAverages) {
  const Image alpha = coefficients({6, 5}, 3);
  const MipChain chain(alpha);
  for (int row = 0; row < 15; ++row) {
    for (int column = 0; column < 13; ++column) {
      const double x = 0.9 * column - 2.1;
      const double y = 0.7 * row - 2.3;
      EXPECT_NEAR(chain.bilinear(0, x, y)[1], kernel_at(alpha, 1, x, y), 1e-6) << x << " " << y;
      double expected = 0;  // averages of 2 x 2 from (0, 0) on have their centers at 2k + 1/2
      for (int j = 0; j < 6; j += 2) {
        for (int i = 0; i < 6; i += 2) {
          double average = 0;
          for (int k = 0; k < 4; ++k) {
            if (j + k / 2 < 5) average += alpha.at(1, i + k % 2, j + k / 2) / 4.0;
          }
          expected += average * bspline(1, (x - i - 0.5) / 2) * bspline(1, (y - j - 0.5) / 2);
        }
      }
      EXPECT_NEAR(chain.bilinear(1, x, y)[1], expected, 1e-6) << x << " " << y;
      EXPECT_NEAR(chain.trilinear(0.25, x, y)[1], 0.75 * kernel_at(alpha, 1, x, y) + 0.25 * expected, 1e-6);
    }
  }
}

TEST(KernelFilter, OfAPixelAsLargeAsACoefficientHardwareFiltersDoNothing) {
  const Image alpha = coefficients({9, 7}, 1);
  const MipChain chain(alpha);
  for (const TextonFilter filter : {TextonFilter::trilinear, TextonFilter::anisotropic}) {
    for (const double size : {0.01, 1.0}) {
      const KernelFilter filtered(filter, columns(size, 0, 0, size), chain.coarsest());
      EXPECT_EQ(filtered(chain, 3.3, 2.8), chain.bilinear(0, 3.3, 2.8));
      EXPECT_EQ(filtered.texels(), 4);
    }
  }
}

/// As the footprint vanishes EWA is a Gaussian of variance 1/6 an axis, that of β^1, cut at three standard deviations
/// and divided by its sum: here on a smooth kernel, which both reproduce.
TEST(KernelFilter, OfAVanishingFootprintEwaIsAGaussianOfTheVarianceOfASpline) {
  Image smooth({24, 24}, 1);
  for (int y = 0; y < 24; ++y) {
    for (int x = 0; x < 24; ++x)
      smooth.at(0, x, y) = std::exp(-0.02F * static_cast<float>((x - 12) * (x - 12) + (y - 11) * (y - 11)));
  }
  const MipChain chain(smooth);
  const KernelFilter ewa(TextonFilter::ewa, columns(1e-6, 0, 0, 1e-6), chain.coarsest());
  for (const auto& [x, y] : {std::pair{12.0, 11.0}, {9.5, 14.25}, {15.1, 7.7}}) {
    EXPECT_NEAR(ewa(chain, x, y)[0], chain.bilinear(0, x, y)[0], 0.01) << x << " " << y;
    double sum = 0;
    double total = 0;
    for (int j = 0; j < 24; ++j) {
      for (int i = 0; i < 24; ++i) {
        const double q = 6 * ((x - i) * (x - i) + (y - j) * (y - j));
        const double weight = q <= 9 ? std::exp(-q / 2) : 0;
        sum += weight * smooth.at(0, i, j);
        total += weight;
      }
    }
    EXPECT_NEAR(ewa(chain, x, y)[0], sum / total, 1e-6);
  }
}

/// ∫ filtered h = ∫ h, by sums on a grid of spacing 1/4 over the window that margin() states, which must hold all of
/// it.
TEST(KernelFilter, HasUnitGainAndStaysInItsMargin) {
  const Image alpha = coefficients({9, 6}, 1);
  const MipChain chain(alpha);
  for (const TextonFilter filter :
       {TextonFilter::none, TextonFilter::trilinear, TextonFilter::anisotropic, TextonFilter::ewa}) {
    for (const Eigen::Matrix2d& footprint :
         {columns(1, 0, 0, 1), columns(3, 0, 0, 3), columns(2, 1, -1, 11), columns(0.4, 0, 6, 2)}) {
      const KernelFilter filtered(filter, footprint, chain.coarsest());
      const Eigen::Vector2d margin = filtered.margin();
      double inside = 0;
      double outside = 0;
      for (int j = -200; j < 260; ++j) {
        for (int i = -200; i < 260; ++i) {
          const double x = i / 4.0 + 0.125;
          const double y = j / 4.0 + 0.125;
          const double value = filtered(chain, x, y)[0];
          const bool within =
              x > -0.5 - margin.x() && x < 8.5 + margin.x() && y > -0.5 - margin.y() && y < 5.5 + margin.y();
          (within ? inside : outside) += within ? value / 16 : std::abs(value);
        }
      }
      EXPECT_EQ(outside, 0);
      // Box averages of tents are summed without error; Gaussians cut at 3 sd by a lattice of four points a unit.
      const double tolerance = filter == TextonFilter::ewa ? 5e-3 : 1e-5;
      EXPECT_NEAR(inside / kernel_sum(alpha, 0), 1, tolerance) << static_cast<int>(filter) << "\n" << footprint;
    }
  }
}

/// A long footprint: 16 probes blur along it and not across it. The variance that a filter adds along an axis is the
/// second moment of the response to a single coefficient.
TEST(KernelFilter, AnisotropicProbesBlurAlongTheLongerSideOnly) {
  const MipChain wide([] {
    Image point({33, 33}, 1);
    point.at(0, 16, 16) = 1;
    return point;
  }());
  const Eigen::Matrix2d footprint = columns(1, 0, 0, 12);
  const auto spread = [&](TextonFilter filter) {
    const KernelFilter filtered(filter, footprint, wide.coarsest());
    Eigen::Vector2d moments = Eigen::Vector2d::Zero();
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    for (int j = 0; j < 400; ++j) {
      for (int i = 0; i < 400; ++i) {
        const Eigen::Vector2d place((i + 0.5) / 4 - 34, (j + 0.5) / 4 - 34);
        const double value = filtered(wide, place.x(), place.y())[0] / 16;
        mean += value * place;
        moments += value * place.cwiseAbs2();
      }
    }
    return Eigen::Vector2d(moments - mean.cwiseAbs2());
  };
  // Across: β^1, of variance 1/6. Along: besides, 12 probes at 12 (i/13 − 1/2), of variance 12² · 11 / (12 · 13), where
  // a pixel has 12²/12.
  const Eigen::Vector2d anisotropic = spread(TextonFilter::anisotropic);
  EXPECT_NEAR(anisotropic.x(), 1.0 / 6, 0.02);
  EXPECT_NEAR(anisotropic.y(), 1.0 / 6 + 144.0 * 11 / (12 * 13), 0.2);
  // Two moments of a Gaussian cut at 3 sd in the plane: 1 − 4.5 e^−4.5 / (1 − e^−4.5) = 0.949 of the variance.
  const Eigen::Vector2d ewa = spread(TextonFilter::ewa);
  EXPECT_NEAR(ewa.x(), 0.949 * (1.0 / 12 + 1.0 / 6), 0.02);
  EXPECT_NEAR(ewa.y(), 0.949 * (144.0 / 12 + 1.0 / 6), 0.2);
  // A single level for all directions blurs across as much as along.
  const Eigen::Vector2d trilinear = spread(TextonFilter::trilinear);
  EXPECT_GT(trilinear.x(), 10);
}

TEST(KernelFilter, RefusesFootprintsThatAreNoParallelogram) {
  const double inf = std::numeric_limits<double>::infinity();
  for (const Eigen::Matrix2d& footprint :
       {columns(1, 0, 0, std::nan("")), columns(inf, 0, 0, 1), columns(1, 2, 2, 4), columns(0, 0, 0, 1)}) {
    try {
      const KernelFilter filter(TextonFilter::ewa, footprint, 3);
      ADD_FAILURE() << footprint;
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("expected finite, independent ones"));
    }
  }
  EXPECT_THROW(MipChain(Image({4, 4}, 5)), std::invalid_argument);
}

}  // namespace textonbench::texton_filter_test
