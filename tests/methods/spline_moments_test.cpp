#include "methods/spot/spline_moments.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "methods/base/bspline.h"
#include "methods/base/random.h"
#include "methods/spot/kernel_moments.h"
#include "methods/spot/spline_noise.h"

namespace textonbench::spline_moments_test {

SplineTexton random_texton(int order, Extent extent, std::uint64_t kernels) {
  SplineTexton texton{.coefficients = {}, .order = order};
  texton.coefficients.support_pixels = extent.area();
  texton.coefficients.mean = {0};
  texton.support_area = (extent.width + order) * (extent.height + order);
  for (std::uint64_t k = 0; k < kernels; ++k) {
    Image& alpha = texton.coefficients.kernels.emplace_back(extent, 1);
    for (int y = 0; y < extent.height; ++y) {
      fill_normal(Stream(Seed{k}), static_cast<std::uint64_t>(y), 0, alpha.row(0, y));
    }
  }
  return texton;
}

TEST(SplineMoments, OfOrderZeroAreThoseOfTheKernelsPixels) {
  const SplineTexton texton = random_texton(0, {7, 5}, 3);
  EXPECT_NEAR(spline_kurtosis(texton)[0], poisson_moments(texton.coefficients, 1)[0].excess_kurtosis, 1e-12);
}

/// One coefficient: A ∫ β⁴ ∫ β⁴ / (∫ β²)⁴ by the midpoint rule, whose error here is below 1e-7.
TEST(SplineMoments, OfOneSplineAreThoseOfItsIntegrals) {
  for (int order = 1; order <= max_bspline_order; ++order) {
    SplineTexton texton = random_texton(order, {1, 1}, 1);
    constexpr int steps = 60000;
    double second = 0;
    double fourth = 0;
    for (int i = 0; i < steps; ++i) {
      const double b = bspline(order, 3 * (2.0 * i + 1 - steps) / steps);
      second += 6 * b * b / steps;
      fourth += 6 * b * b * b * b / steps;
    }
    const double expected = (order + 1) * (order + 1) * std::pow(fourth / (second * second), 2);
    EXPECT_NEAR(spline_kurtosis(texton)[0], expected, 1e-6 * expected) << order;
  }
}

TEST(SplineMoments, OfAChannelWithoutValuesAreZero) {
  SplineTexton texton = random_texton(1, {3, 3}, 1);
  texton.coefficients.kernels[0] = Image({3, 3}, 1);
  EXPECT_EQ(spline_kurtosis(texton)[0], 0);
}

TEST(StratifiedSplineMoments, OfOrderZeroAreTheMeanOverAllLatticesOfThoseOnPixels) {
  // ∫ s̄² by the midpoint rule over the places of a cell of 4 pixels.
  const SplineTexton texton = random_texton(0, {6, 6}, 2);
  constexpr int side = 4;
  constexpr int fine = 200;  // places of the cell's corner in a pixel, by the midpoint rule
  const auto covered = [&](double low, int pixel) {
    return std::max(0.0, std::min(low + side, pixel + 1.0) - std::max(low, double(pixel)));
  };
  double second = 0, fourth = 0, of_means = 0;
  const auto s = [&](int x, int y) {
    double sum = 0;
    for (const Image& kernel : texton.coefficients.kernels) sum += std::pow(double(kernel.at(0, x, y)), 2);
    return sum;
  };
  for (int y = 0; y < 6; ++y) {
    for (int x = 0; x < 6; ++x) {
      second += s(x, y);
      for (const Image& kernel : texton.coefficients.kernels) fourth += std::pow(double(kernel.at(0, x, y)), 4);
    }
  }
  std::vector<std::vector<double>> weights;  // of the pixels in a cell, for every place of it
  for (int i = 0; i < (6 + side) * fine; ++i) {
    std::vector<double>& row = weights.emplace_back();
    for (int pixel = 0; pixel < 6; ++pixel) row.push_back(covered(-side + (i + 0.5) / fine, pixel) / side);
  }
  double products[6][6] = {};
  for (const std::vector<double>& row : weights) {
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t j = 0; j < 6; ++j) products[i][j] += row[i] * row[j] / fine;
    }
  }
  for (int i = 0; i < 6 * 6; ++i) {
    for (int j = 0; j < 6 * 6; ++j) {
      of_means += s(i % 6, i / 6) * products[i / 6][j / 6] * products[i % 6][j % 6] * s(j % 6, j / 6);
    }
  }
  const double expected = side * side * (2 * fourth - 3 * of_means) / (second * second);
  EXPECT_NEAR(stratified_spline_kurtosis(texton, 36.0 / (side * side))[0], expected, 1e-4 * std::abs(expected));
}

/// One fixed key: 4e5 independent points of noise; the fourth moment of a sum of so few impacts has a standard error of
/// about 0.01 of the kurtosis' scale, and 4 standard errors are a false alarm of 6e-5.
TEST(StratifiedSplineMoments, AreThoseOfSamples) {
  for (const int order : {1, 3}) {
    for (const double mni : {1.5, 4.0}) {
      SplineTexton texton = random_texton(order, {9, 7}, 2);
      const auto model = make_spline_noise(texton, {.impacts = ImpactProcess::stratified, .mni = mni});
      constexpr int side = 640;
      std::vector<Point2> points;
      points.reserve(side * side);
      for (int i = 0; i < side * side; ++i) points.push_back({(i % side) * 37.31, (i / side) * 41.17});
      std::vector<float> values(points.size());
      model->procedural()->evaluate(points, Seed{7}, values);
      double second = 0, fourth = 0, eighth = 0;
      for (const float v : values) {
        const double square = double(v) * double(v);
        second += square / (side * side);
        fourth += square * square / (side * side);
        eighth += std::pow(square, 4) / (side * side);
      }
      const double error = std::sqrt((eighth - fourth * fourth) / (side * side)) / (second * second);
      EXPECT_NEAR(stratified_spline_kurtosis(texton, mni)[0], fourth / (second * second) - 3, 4 * error)
          << order << " " << mni;
    }
  }
}

TEST(StratifiedSplineMoments, TendToThoseOfPoissonImpactsWhereOneCellHoldsAllOfTheKernel) {
  const SplineTexton texton = random_texton(1, {5, 4}, 1);
  const double mni = 1e-3;
  EXPECT_NEAR(stratified_spline_kurtosis(texton, mni)[0] * mni, spline_kurtosis(texton)[0],
              0.01 * spline_kurtosis(texton)[0]);
}

}  // namespace textonbench::spline_moments_test
