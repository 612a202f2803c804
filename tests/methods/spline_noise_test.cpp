#include "methods/spot/spline_noise.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/methods/plain_spline_noise.h"
#include "tests/texton.h"

namespace textonbench::spline_noise_test {

SplineTexton spline_texton(Extent extent, int channels, int kernels, int order) {
  SplineTexton texton{test_texton(extent, channels, kernels), order, 0};
  texton.support_area = static_cast<double>(extent.width + order) * (extent.height + order);
  return texton;
}

/// The grid that the model uses when options.cell is given.
ImpactGrid grid_of(const SplineTexton& texton, const SplineNoiseOptions& options) {
  return {options.impacts, options.mni / texton.support_area, options.cell * std::sqrt(texton.support_area),
          static_cast<int>(texton.coefficients.kernels.size())};
}

double standard_deviation(const Model& model, int channel) {
  return std::sqrt(color_covariance(model.gaussian()->spectrum({128, 128}))(channel, channel));
}

std::vector<Point2> points_near(Point2 center, double spread, int count, std::uint64_t seed) {
  RandomSequence random(Stream(Seed{seed}).child("points"));
  std::vector<Point2> points;
  for (int i = 0; i < count; ++i) {
    const double x = center.x + spread * (random.uniform() - 0.5);
    points.push_back({x, center.y + spread * (random.uniform() - 0.5)});
  }
  return points;
}

std::vector<float> evaluate(const Model& model, const std::vector<Point2>& points, std::uint64_t seed) {
  std::vector<float> values(points.size() * static_cast<std::size_t>(model.spline_texton()->coefficients.channels()));
  model.procedural()->evaluate(points, Seed{seed}, values);
  return values;
}

std::vector<float> gradient(const Model& model, const std::vector<Point2>& points, std::uint64_t seed) {
  std::vector<float> values(2 * points.size() *
                            static_cast<std::size_t>(model.spline_texton()->coefficients.channels()));
  model.procedural()->gradient(points, Seed{seed}, values);
  return values;
}

/// Largest difference of two images in standard deviations of the noise.
double distance(const Model& model, const Image& a, const Image& b) {
  double largest = 0;
  for (int c = 0; c < a.channels(); ++c) {
    const double deviation = standard_deviation(model, c);
    for (int y = 0; y < a.height(); ++y) {
      for (int x = 0; x < a.width(); ++x) {
        largest = std::max(largest, std::abs(a.at(c, x, y) - b.at(c, x, y)) / deviation);
      }
    }
  }
  return largest;
}

bool same_bits(const Image& a, const Image& b) {
  for (int i = 0; i < a.channels() * a.height(); ++i) {
    if (!std::ranges::equal(a.row(i / a.height(), i % a.height()), b.row(i / a.height(), i % a.height()))) return false;
  }
  return true;
}

struct Shape {
  Extent extent;
  int channels, kernels, order;
  ImpactProcess process;
};

const std::vector<Shape> shapes = {
    {{16, 16}, 3, 1, 0, ImpactProcess::poisson},    {{16, 13}, 3, 1, 1, ImpactProcess::poisson},
    {{9, 20}, 1, 2, 2, ImpactProcess::stratified},  {{12, 12}, 8, 3, 3, ImpactProcess::poisson},
    {{7, 5}, 5, 1, 4, ImpactProcess::stratified},   {{10, 11}, 4, 2, 5, ImpactProcess::poisson},
    {{24, 24}, 3, 1, 1, ImpactProcess::stratified}, {{14, 14}, 3, 1, 1, ImpactProcess::paper},
    {{2, 1}, 1, 1, 1, ImpactProcess::poisson},
};

TEST(SplineNoise, PointsAreTheDefinition) {
  for (const Shape& shape : shapes) {
    const SplineTexton texton = spline_texton(shape.extent, shape.channels, shape.kernels, shape.order);
    const SplineNoiseOptions options{.impacts = shape.process, .mni = 12, .cell = 0.5};
    const auto model = make_spline_noise(texton, options);
    const PlainSplineNoise plain(texton, grid_of(texton, options), Seed{3});
    for (const Point2 center : {Point2{0, 0}, Point2{-0x1p33, 0x1p36 + 0.25}}) {
      const auto points = points_near(center, 90, 60, 5);
      const auto values = evaluate(*model, points, 3);
      for (int c = 0; c < shape.channels; ++c) {
        const double deviation = standard_deviation(*model, c);
        for (std::size_t i = 0; i < points.size(); ++i) {
          // Positions are rounded to 2^−22 pixel, values to float.
          EXPECT_NEAR(values[static_cast<std::size_t>(c) * points.size() + i], plain.value(c, points[i]),
                      1e-5 * deviation)
              << "order " << shape.order << " channel " << c;
        }
      }
    }
  }
}

TEST(SplineNoise, GradientsAreThoseOfTheDefinitionAndOfFiniteDifferences) {
  for (const Shape& shape : shapes) {
    const SplineTexton texton = spline_texton(shape.extent, shape.channels, shape.kernels, shape.order);
    const SplineNoiseOptions options{.impacts = shape.process, .mni = 12, .cell = 0.5};
    const auto model = make_spline_noise(texton, options);
    EXPECT_EQ(model->procedural()->smoothness(), shape.order);
    const auto points = points_near({4e4, -3e5}, 60, 40, 6);
    if (shape.order == 0) {
      EXPECT_THROW(gradient(*model, points, 3), std::invalid_argument);
      continue;
    }
    const PlainSplineNoise plain(texton, grid_of(texton, options), Seed{3});
    const auto slopes = gradient(*model, points, 3);
    const auto channels = static_cast<std::size_t>(shape.channels);
    for (std::size_t c = 0; c < channels; ++c) {
      const double deviation = standard_deviation(*model, static_cast<int>(c));
      for (std::size_t i = 0; i < points.size(); ++i) {
        for (const int axis : {1, 2}) {
          const double slope = slopes[((static_cast<std::size_t>(axis) - 1) * channels + c) * points.size() + i];
          EXPECT_NEAR(slope, plain.slope(static_cast<int>(c), points[i], axis), 2e-5 * deviation);
        }
        if (shape.order >= 3) {
          const double h = 1e-3;
          const Point2 left{points[i].x - h, points[i].y};
          const Point2 right{points[i].x + h, points[i].y};
          const double difference =
              (plain.value(static_cast<int>(c), right) - plain.value(static_cast<int>(c), left)) / (2 * h);
          EXPECT_NEAR(slopes[c * points.size() + i], difference, 1e-4 * deviation);
        }
      }
    }
  }
}

TEST(SplineNoise, ContinuousFromOrderOneOn) {
  // Steps of 1/4096 pixel across knots and borders of kernels: a field whose slope is bounded moves little.
  for (int order = 0; order <= 5; ++order) {
    const auto model = make_spline_noise(spline_texton({9, 9}, 1, 1, order), {.mni = 8});
    std::vector<Point2> points;
    for (int i = 0; i < 40960; ++i) points.push_back({17 + i * 0x1p-12, 2.3});
    const auto values = evaluate(*model, points, 8);
    double largest = 0;
    for (std::size_t i = 1; i < values.size(); ++i) {
      largest = std::max(largest, static_cast<double>(std::abs(values[i] - values[i - 1])));
    }
    const double deviation = standard_deviation(*model, 0);
    if (order == 0) {
      EXPECT_GT(largest, 0.05 * deviation);
    } else {
      EXPECT_LT(largest, 0.005 * deviation) << order;
    }
  }
}

TEST(SplineNoise, AnyOrderOfPointsAndNumberOfThreadsGivesTheSameBits) {
  const auto model = make_spline_noise(spline_texton({24, 24}, 3, 1, 1), {});
  auto points = points_near({-50, 70}, 200, 3000, 4);
  const auto values = evaluate(*model, points, 9);
  std::ranges::reverse(points);
  std::vector<float> reversed;
  {
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    reversed = evaluate(*model, points, 9);
  }
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      ASSERT_EQ(values[c * points.size() + i], reversed[(c + 1) * points.size() - 1 - i]);
    }
  }
}

TEST(SplineNoise, RoutesDrawTheFieldOfThePoints) {
  for (const Shape& shape : shapes) {
    const SplineTexton texton = spline_texton(shape.extent, shape.channels, shape.kernels, shape.order);
    const Domain domain{.size = {75, 50}, .origin = {-33.75, 1e6 + 0.3}};
    const auto draw = [&](SplineRoute route) {
      return make_spline_noise(texton, {.impacts = shape.process, .mni = 9, .route = route})
          ->synthesize(domain, Seed{2});
    };
    const Image points = draw(SplineRoute::points);
    const auto model = make_spline_noise(texton, {.impacts = shape.process, .mni = 9});
    EXPECT_LT(distance(*model, points, draw(SplineRoute::impacts)), 1e-5) << shape.order;
    EXPECT_LT(distance(*model, points, draw(SplineRoute::convolution)), 1e-5) << shape.order;
    EXPECT_LT(distance(*model, points, draw(SplineRoute::automatic)), 1e-5) << shape.order;

    std::vector<Point2> pixels;
    for (int i = 0; i < 75 * 50; ++i) pixels.push_back({domain.origin.x + i % 75, domain.origin.y + i / 75});
    const auto values = evaluate(*model, pixels, 2);
    for (int c = 0; c < shape.channels; ++c) {
      for (int y = 0; y < 50; ++y) {
        for (int x = 0; x < 75; ++x) {
          ASSERT_EQ(points.at(c, x, y), values[static_cast<std::size_t>((c * 50 + y) * 75 + x)]);
        }
      }
    }
  }
}

TEST(SplineNoise, WindowsAgreeBitForBit) {
  for (const Shape& shape : shapes) {
    const SplineTexton texton = spline_texton(shape.extent, shape.channels, shape.kernels, shape.order);
    for (const SplineRoute route : {SplineRoute::points, SplineRoute::impacts}) {
      const auto model = make_spline_noise(texton, {.impacts = shape.process, .mni = 9, .route = route});
      for (const Point2 origin : {Point2{-20.5, 11}, Point2{0x1p38, -0x1p37 + 0.125}}) {
        const Image whole = model->synthesize({.size = {90, 70}, .origin = origin}, Seed{7});
        const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
        const Image part = model->synthesize({.size = {41, 33}, .origin = {origin.x + 29, origin.y + 18}}, Seed{7});
        EXPECT_TRUE(same_bits(crop(whole, 29, 18, {41, 33}), part)) << shape.order;
      }
    }
  }
}

TEST(SplineNoise, AnyStepIsDrawn) {
  const SplineTexton texton = spline_texton({16, 16}, 3, 1, 1);
  const auto model = make_spline_noise(texton, {});
  for (const double step : {0.05, 0.37, 40.0}) {
    const Domain domain{.size = {40, 35}, .origin = {3.1, -8.2}, .step = step};
    const Image image = model->synthesize(domain, Seed{2});
    const auto values = evaluate(*model, {{3.1 + 39 * step, -8.2 + 34 * step}}, 2);
    EXPECT_EQ(image.at(2, 39, 34), values[2]);
  }
  const auto by_impact = make_spline_noise(texton, {.route = SplineRoute::impacts});
  EXPECT_THROW(by_impact->synthesize({.size = {9, 9}, .step = 0.5}, Seed{1}), std::invalid_argument);
}

TEST(SplineNoise, RefusesWhatItCannotDraw) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(refuse_spline_noise({.size = {8, 8}, .periodic = true}));
  EXPECT_TRUE(refuse_spline_noise({.size = {8, 8}, .step = 0}));
  EXPECT_TRUE(refuse_spline_noise({.size = {8, 8}, .step = nan}));
  EXPECT_TRUE(refuse_spline_noise({.size = {8, 8}, .origin = {0, nan}}));
  EXPECT_TRUE(refuse_spline_noise({.size = {8, 8}, .origin = {0x1p40, 0}}));
  EXPECT_FALSE(refuse_spline_noise({.size = {8, 8}, .origin = {-0x1p40, 0.5}, .step = 0.5}));

  const SplineTexton good = spline_texton({8, 8}, 3, 2, 1);
  for (const double mni : {0.0, -1.0, nan, 1e9}) {
    EXPECT_THROW(make_spline_noise(good, {.mni = mni}), std::invalid_argument) << mni;
  }
  EXPECT_THROW(make_spline_noise(good, {.mni = 1000, .cell = 3}), std::invalid_argument);
  EXPECT_THROW(make_spline_noise(good, {.cell = -1}), std::invalid_argument);
  EXPECT_NO_THROW(make_spline_noise(good, {.mni = 0.25}));
  const auto broken = [&](const auto& change) {
    SplineTexton texton = good;
    change(texton);
    EXPECT_THROW(make_spline_noise(texton, {}), std::invalid_argument);
  };
  broken([](SplineTexton& t) { t.order = 6; });
  broken([](SplineTexton& t) { t.coefficients.kernels.clear(); });
  broken([](SplineTexton& t) { t.coefficients.kernels[1] = Image({8, 7}, 3); });
  broken([&](SplineTexton& t) { t.coefficients.kernels[1].at(2, 3, 4) = static_cast<float>(nan); });
  broken([](SplineTexton& t) { t.coefficients.mean.pop_back(); });
  broken([](SplineTexton& t) { t.support_area = 82; });

  const auto model = make_spline_noise(good, {});
  std::vector<float> out(3);
  for (const Point2 p : {Point2{nan, 0}, Point2{0, std::numeric_limits<double>::infinity()}, Point2{0x1p41, 0}}) {
    EXPECT_THROW(model->procedural()->evaluate({&p, 1}, Seed{1}, out), std::invalid_argument);
  }
  out.resize(4);
  const Point2 origin{};
  EXPECT_THROW(model->procedural()->evaluate({&origin, 1}, Seed{1}, out), std::invalid_argument);
}

}  // namespace textonbench::spline_noise_test
