#include "methods/spot/surface_sum.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>

#include "methods/base/bspline.h"

namespace textonbench::surface_sum_test {

using Eigen::Vector3d;

SplineTexton random_texton(Extent box, int order, int kernels = 1, int channels = 2) {
  SplineTexton texton;
  texton.order = order;
  texton.support_area = (box.width + order) * (box.height + order);
  for (int k = 0; k < kernels; ++k) {
    Image kernel(box, channels);
    for (int c = 0; c < channels; ++c) {
      for (int y = 0; y < box.height; ++y) {
        fill_normal(Stream(Seed{9}).child(static_cast<std::uint64_t>(k)), static_cast<std::uint64_t>(100 * c + y), 0,
                    kernel.row(c, y));
      }
    }
    texton.coefficients.kernels.push_back(std::move(kernel));
  }
  texton.coefficients.mean.assign(static_cast<std::size_t>(channels), 0.5);
  return texton;
}

Vector3d random_direction(RandomSequence& random) {
  return Vector3d(random.normal(), random.normal(), random.normal()).normalized();
}

SurfacePoint random_point(RandomSequence& random, double spread) {
  const Vector3d position(spread * random.normal(), spread * random.normal(), spread * random.normal());
  SurfacePoint point = surface_point(position, random_direction(random));
  const Eigen::AngleAxisd turn(6.3 * random.uniform(), point.normal);
  point.u1 = turn * point.u1;
  point.u2 = turn * point.u2;
  return point;
}

double kernel_value(const Image& kernel, int c, int order, double x, double y) {
  double sum = 0;
  for (int j = 0; j < kernel.height(); ++j) {
    for (int i = 0; i < kernel.width(); ++i) {
      sum += kernel.at(c, i, j) * bspline(order, x - i) * bspline(order, y - j);
    }
  }
  return sum;
}

double total(const Image& kernel, int c) {
  double sum = 0;
  for (int y = 0; y < kernel.height(); ++y) {
    for (int x = 0; x < kernel.width(); ++x) {
      sum += kernel.at(c, x, y);
    }
  }
  return sum;
}

/// ∫ h^power by a fine grid; exact to 1e-3 and better for order 1.
double integral_of_power(const Image& kernel, int c, int order, int power) {
  constexpr int fine = 12;
  double sum = 0;
  for (int j = 0; j < (kernel.height() + order) * fine; ++j) {
    for (int i = 0; i < (kernel.width() + order) * fine; ++i) {
      const double x = (i + 0.5) / fine - (order + 1) / 2.0;
      const double y = (j + 0.5) / fine - (order + 1) / 2.0;
      sum += std::pow(kernel_value(kernel, c, order, x, y), power);
    }
  }
  return sum / (fine * fine);
}

/// The formula of the header, over every cell within 2 r.
double plain_value(const SurfaceSum& noise, const SurfacePoint& point, Seed seed, int c) {
  const SplineTexton& texton = noise.texton();
  const double r = noise.thickness();
  const auto cell = [&](double x) { return static_cast<std::int32_t>(std::floor(x / noise.grid().side())); };
  const auto kernels = static_cast<double>(texton.coefficients.kernels.size());
  double sum = 0;
  const Vector3d low = point.position - Vector3d::Constant(2 * r);
  const Vector3d high = point.position + Vector3d::Constant(2 * r);
  for (std::int32_t cx = cell(low.x()); cx <= cell(high.x()); ++cx) {
    for (std::int32_t cy = cell(low.y()); cy <= cell(high.y()); ++cy) {
      for (std::int32_t cz = cell(low.z()); cz <= cell(high.z()); ++cz) {
        std::vector<SurfaceImpact> impacts;
        noise.grid().draw_cell(Stream(seed).child("surface"), cx, cy, cz, impacts);
        for (const SurfaceImpact& impact : impacts) {
          const Vector3d d = point.position - impact.position;
          const Image& kernel = texton.coefficients.kernels[static_cast<std::size_t>(impact.kernel)];
          sum += impact.weight * std::sqrt(kernels) * std::max(0.0, 1 - 2 / r * std::abs(d.dot(point.normal))) *
                 kernel_value(kernel, c, texton.order, d.dot(point.u1) + (kernel.width() - 1) / 2.0,
                              d.dot(point.u2) + (kernel.height() - 1) / 2.0);
        }
      }
    }
  }
  double expected = 0;
  for (const Image& kernel : texton.coefficients.kernels) {
    expected += noise.grid().mean_weight() * r / 2 * total(kernel, c) / std::sqrt(kernels);
  }
  return texton.coefficients.mean[static_cast<std::size_t>(c)] +
         (sum - expected) / std::sqrt(noise.intensity() * r / 3);
}

class SurfaceSumTest : public testing::TestWithParam<ImpactProcess> {};

TEST_P(SurfaceSumTest, IsTheFormula) {
  for (const int order : {0, 1, 3}) {
    const SurfaceSum noise(random_texton({6, 5}, order, 2), {.impacts = GetParam(), .mni = 20});
    RandomSequence random(Stream(Seed{3}).child(static_cast<std::uint64_t>(order)));
    std::vector<SurfacePoint> points;
    for (int i = 0; i < 12; ++i) {
      points.push_back(random_point(random, 30));
    }
    std::vector<float> values(2 * points.size());
    noise.evaluate(points, Seed{7}, values);
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (int c = 0; c < 2; ++c) {
        EXPECT_NEAR(values[static_cast<std::size_t>(c) * points.size() + i], plain_value(noise, points[i], Seed{7}, c),
                    2e-5)
            << "order " << order << ", point " << i;
      }
    }
  }
}

TEST_P(SurfaceSumTest, AValueHasTheSameBitsInAnyCompany) {
  const SurfaceSum noise(random_texton({6, 6}, 0), {.impacts = GetParam()});
  RandomSequence random(Stream(Seed{4}));
  std::vector<SurfacePoint> points;
  for (int i = 0; i < 500; ++i) {
    points.push_back(surface_point({0.1 * i, 3, -2}, random_direction(random)));
  }
  std::vector<float> together(2 * points.size());
  noise.evaluate(points, Seed{1}, together);
  for (std::size_t i = 0; i < points.size(); i += 41) {
    std::vector<float> alone(2);
    noise.evaluate({&points[i], 1}, Seed{1}, alone);
    EXPECT_EQ(alone[0], together[i]);
    EXPECT_EQ(alone[1], together[points.size() + i]);
  }
}

// Proposition 3, at points far enough apart to be independent, each with a frame of its own. Bounds of 4.5 standard
// errors, known for the mean and from the closed-form kurtosis for the variance: 2 false alarms in 1e5 each.
TEST_P(SurfaceSumTest, MeanAndVarianceAreThoseOfThePlane) {
  for (const int order : {0, 1}) {
    const SplineTexton texton = random_texton({7, 7}, order, 1, 1);
    const SurfaceSum noise(texton, {.impacts = GetParam(), .mni = 8});
    RandomSequence random(Stream(Seed{11}));
    std::vector<SurfacePoint> points;
    constexpr int side = 24;
    points.reserve(side * side * side);
    for (int i = 0; i < side * side * side; ++i) {
      SurfacePoint point = random_point(random, 0);
      point.position = 2.5 * noise.thickness() * Vector3d(i % side, i / side % side, i / side / side);
      point.position += 3 * random_direction(random);
      points.push_back(point);
    }
    std::vector<float> values(points.size());
    noise.evaluate(points, Seed{2}, values);
    const Image& kernel = texton.coefficients.kernels.front();
    const double variance = integral_of_power(kernel, 0, order, 2);
    const double kernel_kurtosis = texton.support_area * integral_of_power(kernel, 0, order, 4) / (variance * variance);
    const double excess = 9.0 / 5 * kernel_kurtosis / 8;  // of Poisson impacts; an upper bound of the other process'
    double mean = 0;
    double square = 0;
    double fourth = 0;
    const auto count = static_cast<double>(values.size());
    for (const float value : values) {
      mean += (value - 0.5) / count;
      square += std::pow(value - 0.5, 2) / count;
      fourth += std::pow(value - 0.5, 4) / count;
    }
    EXPECT_NEAR(mean, 0, 4.5 * std::sqrt(variance / count));
    EXPECT_NEAR(square / variance, 1, 4.5 * std::sqrt((2 + excess) / count));
    if (GetParam() == ImpactProcess::poisson) {
      EXPECT_NEAR(fourth / (square * square) - 3, excess, 0.35 * excess) << "order " << order;
    } else {
      EXPECT_LT(fourth / (square * square) - 3, excess);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Processes, SurfaceSumTest, testing::Values(ImpactProcess::poisson, ImpactProcess::stratified),
                         [](const auto& process) {
                           return process.param == ImpactProcess::poisson ? "poisson" : "stratified";
                         });

// MNI = λ r |S|: a point expects as many impacts within reach.
TEST(SurfaceImpactsTest, MeanNumberOfImpactsIsMni) {
  const SplineTexton texton = random_texton({9, 9}, 0, 1, 1);
  const SurfaceSum noise(texton, {.mni = 20});
  const double r = noise.thickness();
  std::vector<SurfaceImpact> impacts;
  const int cells = 24;
  for (int i = 0; i < cells * cells * cells; ++i) {
    noise.grid().draw_cell(Stream(Seed{8}), i % cells, i / cells % cells, i / cells / cells, impacts);
  }
  const double volume = std::pow(cells * noise.grid().side(), 3);
  const double expected = 20 * volume / (r * r * r);
  EXPECT_NEAR(static_cast<double>(impacts.size()), expected, 4.5 * std::sqrt(expected));
}

TEST(SurfaceImpactsTest, WhatIsOutOfRangeIsRefused) {
  const SplineTexton texton = random_texton({5, 5}, 1);
  EXPECT_THROW(SurfaceSum(texton, {.impacts = ImpactProcess::paper}), std::invalid_argument);
  EXPECT_THROW(SurfaceSum(texton, {.mni = 0}), std::invalid_argument);
  EXPECT_THROW(SurfaceSum(texton, {.mni = NAN}), std::invalid_argument);
  EXPECT_THROW(SurfaceSum(texton, {.cell = 0}), std::invalid_argument);
  const SurfaceSum noise(texton, {});
  std::vector<float> out(2);
  const std::vector<SurfacePoint> far{surface_point({1e9, 0, 0}, Vector3d::UnitZ())};
  const std::vector<SurfacePoint> bad{surface_point({0, NAN, 0}, Vector3d::UnitZ())};
  EXPECT_THROW(noise.evaluate(far, Seed{1}, out), std::invalid_argument);
  EXPECT_THROW(noise.evaluate(bad, Seed{1}, out), std::invalid_argument);
}

}  // namespace textonbench::surface_sum_test
