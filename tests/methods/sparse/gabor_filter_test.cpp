// Filtered Gabor noise against the noise convolved by sums.
#include "methods/sparse/gabor_filter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "methods/sparse/gabor.h"
#include "methods/sparse/gabor_spectrum.h"
#include "methods/sparse/gabor_sum.h"

namespace textonbench {
namespace {

/// Low and high frequencies, round and skewed windows that are cut at 1e-4, and complex colors.
GaborField unfiltered_field(GaborPhase phase) {
  GaborField field = gabor_field({.frequency = 0.04, .orientation = 20, .directions = 3, .bandwidth = 0.1, .mni = 6});
  field.bands.push_back(gabor_field({.frequency = 0.3, .directions = 7, .bandwidth = 0.25, .mni = 6}).bands.front());
  field.bands.push_back(field.bands.back());
  field.bands.back().window = {.xx = 0.01, .xy = 0.012, .yy = 0.03, .cut = 0};
  field.channels = 2;
  field.phase = phase;
  for (GaborBand& band : field.bands) {
    band.window.cut = 1e-4;
    band.raster = {100, 100};
    band.color.clear();
    for (std::size_t e = 0; e < band.frequency.size(); ++e) {
      band.color.emplace_back(0.3F, 0.2F);
      band.color.emplace_back(-0.1F, 0.4F);
    }
  }
  return field;
}

Eigen::Matrix2d covariance_of(double xx, double xy, double yy) {
  Eigen::Matrix2d all;
  all << xx, xy, xy, yy;
  return all;
}

/// The convolution as a sum at steps of half a pixel, as far as 6 deviations: frequencies that the field has are below
/// those that alias.
TEST(FilteredGabor, IsTheConvolutionWithTheGaussian) {
  constexpr int aside = 161;
  constexpr double step = 0.5;
  for (const auto& covariance : {covariance_of(1, 0, 1), covariance_of(4, 2.4, 2.2), covariance_of(0.8, -0.9, 6)}) {
    for (const GaborPhase phase : {GaborPhase::random, GaborPhase::sine}) {
      const GaborField field = unfiltered_field(phase);
      Image fine({aside, aside}, 2);
      add_gabor(field, Seed{7}, {-33, 1000.25, step}, fine);
      const GaborField filtered = filtered_gabor(field, covariance);
      for (const GaborBand& band : filtered.bands) EXPECT_EQ(band.raster.width, 0);
      Image expected({aside, aside}, 2);
      add_gabor(filtered, Seed{7}, {-33, 1000.25, step}, expected);
      const Eigen::Matrix2d inverse = covariance.inverse();
      const double scale = step * step / (2 * std::numbers::pi * std::sqrt(covariance.determinant()));
      const int reach = static_cast<int>(6 / step * std::sqrt(covariance.diagonal().maxCoeff())) + 1;
      double largest = 0;
      for (int c = 0; c < 2; ++c) {
        for (int y = reach; y < aside - reach; y += 5) {
          for (int x = reach; x < aside - reach; x += 5) {
            double sum = 0;
            for (int j = -reach; j <= reach; ++j) {
              for (int i = -reach; i <= reach; ++i) {
                const Eigen::Vector2d away(step * i, step * j);
                sum += scale * std::exp(-0.5 * away.dot(inverse * away)) * double{fine.at(c, x - i, y - j)};
              }
            }
            largest = std::max(largest, std::abs(sum - double{expected.at(c, x, y)}));
          }
        }
      }
      // Each of some 30 kernels is off by at most 2e-4 of its color, with any sign: 1.5e-4 of a deviation in all.
      EXPECT_LE(largest / std::sqrt(gabor_covariance(field)(0, 0)), 5e-4) << covariance;
    }
  }
}

/// What filters do one after the other, one of the sum of their covariances does.
TEST(FilteredGabor, AddsCovariances) {
  const GaborField field = unfiltered_field(GaborPhase::random);
  const GaborField twice =
      filtered_gabor(filtered_gabor(field, covariance_of(1, 0.5, 2)), covariance_of(0.5, -0.4, 0.7));
  const GaborField once = filtered_gabor(field, covariance_of(1.5, 0.1, 2.7));
  for (std::size_t b = 0; b < field.bands.size(); ++b) {
    EXPECT_NEAR(twice.bands[b].window.xx, once.bands[b].window.xx, 1e-12);
    EXPECT_NEAR(twice.bands[b].window.xy, once.bands[b].window.xy, 1e-12);
    EXPECT_NEAR(twice.bands[b].window.yy, once.bands[b].window.yy, 1e-12);
    for (std::size_t e = 0; e < field.bands[b].frequency.size(); ++e) {
      EXPECT_NEAR(twice.bands[b].frequency[e].x, once.bands[b].frequency[e].x, 1e-12);
      EXPECT_NEAR(twice.bands[b].frequency[e].y, once.bands[b].frequency[e].y, 1e-12);
      EXPECT_NEAR(std::abs(twice.bands[b].color[2 * e] - once.bands[b].color[2 * e]), 0, 1e-7);
    }
  }
}

/// A footprint that is a line filters along it alone, and none changes nothing.
TEST(FilteredGabor, OfALineAndOfNothing) {
  const GaborField field = unfiltered_field(GaborPhase::random);
  const GaborField same = filtered_gabor(field, Eigen::Matrix2d::Zero());
  EXPECT_NEAR(same.bands[2].window.xy, field.bands[2].window.xy, 1e-12);
  EXPECT_EQ(same.bands[2].color, field.bands[2].color);
  const GaborWindow line = filtered_gabor(field, covariance_of(3, 0, 0)).bands[0].window;
  EXPECT_LT(line.xx, 0.2 * field.bands[0].window.xx + 0.01);
  EXPECT_NEAR(line.yy, field.bands[0].window.yy, 1e-12);
}

TEST(FilteredGabor, TellsWhatItCannotServe) {
  using testing::HasSubstr;
  using testing::ThrowsMessage;
  const auto filtered = [](const Eigen::Matrix2d& covariance) {
    return [=] { static_cast<void>(filtered_gabor(unfiltered_field(GaborPhase::random), covariance)); };
  };
  EXPECT_THAT(filtered(covariance_of(1, 2, 1)), ThrowsMessage<std::invalid_argument>(HasSubstr("semidefinite")));
  EXPECT_THAT(filtered(covariance_of(-1, 0, 1)), ThrowsMessage<std::invalid_argument>(HasSubstr("(-1, 0; 0, 1)")));
  EXPECT_THAT(filtered(covariance_of(NAN, 0, 1)), ThrowsMessage<std::invalid_argument>(HasSubstr("finite matrix")));
  EXPECT_THAT(filtered(covariance_of(1e5, 0, 1)), ThrowsMessage<std::invalid_argument>(HasSubstr("at most 512")));
}

}  // namespace
}  // namespace textonbench
