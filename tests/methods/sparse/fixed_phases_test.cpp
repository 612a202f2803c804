// Local random-phase noise with a structure of fixed phases: lookups, turbulence, placement, filtering.
#include "methods/sparse/fixed_phases.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "methods/sparse/lrp.h"
#include "methods/sparse/wave_filter.h"
#include "tests/texture.h"

namespace textonbench {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

LrpOptions options_of(FixedPhaseOptions fixed) {
  LrpOptions options;
  options.fixed = fixed;
  return options;
}

LrpAnalysis analysis_of(FixedPhaseOptions fixed, int channels = 1) {
  return analyze_lrp(test_exemplar({80, 70}, channels), options_of(fixed), Seed{2});
}

TEST(PlaceAtRandom, WeightsAddUpAndChangeWithoutJumps) {
  const Stream stream = Stream(Seed{5}).child("placement");
  constexpr int period = 64;
  for (const std::int64_t far : {std::int64_t{0}, -(std::int64_t{1} << 55)}) {
    float last = 0;
    for (int i = 0; i < 3000; ++i) {
      // Along a line that crosses borders of both axes, a twentieth of a pixel at a time.
      const WavePoint point{far + i * plane_pixel / 20, far / 2 - 7 * plane_pixel - i * plane_pixel / 31};
      PlacedPoint places[4];
      const int count = place_at_random(stream, period, point, places);
      float sum = 0, weighted = 0;
      for (int k = 0; k < count; ++k) {
        EXPECT_EQ((places[k].point.x - point.x) % plane_pixel, 0) << "whole pixels";
        EXPECT_GE(places[k].point.x, point.x);
        EXPECT_LT(places[k].point.x - point.x, period * plane_pixel);
        sum += places[k].weight;
        // A function of the block alone stands for what is looked up.
        const std::int64_t shift = (places[k].point.x - point.x) / plane_pixel;
        weighted += places[k].weight * static_cast<float>(shift) / period;
      }
      EXPECT_NEAR(sum, 1, 1e-6);
      if (i > 0) {
        EXPECT_NEAR(weighted, last, 0.03) << i;
      }
      last = weighted;
    }
  }
}

TEST(Lrp, WholeStructureIsTheBlockExactly) {
  for (const int channels : {1, 3}) {
    const Exemplar exemplar = test_exemplar({80, 70}, channels);
    const LrpAnalysis analysis = analyze_lrp(exemplar, options_of({.ratio = 1, .reduced = false}), Seed{2});
    EXPECT_TRUE(analysis.layers.empty()) << "nothing is left to noise";
    const Pixel corner = analysis.block;
    EXPECT_EQ(corner, (Pixel{0, 0})) << "the first of the four";
    const auto model = make_lrp(analysis);
    const Image out = model->synthesize({.size = {130, 70}}, Seed{9});
    for (int c = 0; c < channels; ++c) {
      for (int y = 0; y < 70; ++y) {
        for (int x = 0; x < 130; ++x) {
          ASSERT_NEAR(out.at(c, x, y), exemplar.pixels.at(c, corner.x + x % 64, corner.y + y % 64), 1e-5);
        }
      }
    }
    EXPECT_EQ(model->gaussian(), nullptr);
    EXPECT_EQ(model->procedural()->smoothness(), 0);
  }
}

TEST(Lrp, ReducedStructureIsAsPreciseAsAsked) {
  const LrpAnalysis analysis = analysis_of({.ratio = 0.3}, 3);
  const Structure& structure = analysis.fixed->structure;
  EXPECT_EQ(structure.cosines(), 15);
  EXPECT_LE(structure.deviation(), 1. / 256);
  int noise = 0;
  for (const LrpLayer& layer : analysis.layers) noise += layer.stratum.cosines;
  EXPECT_EQ(noise, 35) << "the rest of the budget";
}

TEST(Lrp, StructureAndNoiseShareNoBins) {
  const LrpAnalysis analysis = analysis_of({.ratio = 0.4, .reduced = false});
  const auto fixed = forward_fft(analysis.fixed->structure.image());
  for (const LrpLayer& layer : analysis.layers) {
    for (const Pixel& bin : layer.stratum.bins) {
      EXPECT_LT(std::abs(fixed.at(0, bin.x, (bin.y + 64) % 64)), 1e-3);
    }
  }
}

TEST(Lrp, RasterOfAStructureIsThePointsThemselves) {
  for (const Domain& domain :
       {Domain{.size = {37, 90}}, Domain{.size = {21, 13}, .origin = {-1e9, 33.25}, .step = 0.375}}) {
    const auto model = make_lrp(analysis_of({.ratio = 0.3, .turbulence = 3, .placement = true}, 3));
    const Image out = model->synthesize(domain, Seed{4});
    std::vector<Point2> points;
    for (int y = 0; y < domain.size.height; ++y) {
      for (int x = 0; x < domain.size.width; ++x) {
        points.push_back({domain.origin.x + domain.step * x, domain.origin.y + domain.step * y});
      }
    }
    std::vector<float> values(3 * points.size());
    model->procedural()->evaluate(points, Seed{4}, values);
    for (int c = 0; c < 3; ++c) {
      for (std::size_t i = 0; i < points.size(); ++i) {
        const auto at = static_cast<int>(i);
        ASSERT_NEAR(out.at(c, at % domain.size.width, at / domain.size.width),
                    values[static_cast<std::size_t>(c) * points.size() + i], 1e-5);
      }
    }
  }
}

/// 4000 points far apart: standard errors are 1.6 % of σ for the mean and 1.1 % for the deviation, whose bounds of 7 %
/// and 12 % leave room for waves that are not quite Gaussian.
TEST(FixedPhases, TurbulenceHasMeanZeroAndItsDeviation) {
  const LrpAnalysis analysis = analysis_of({.ratio = 0.3, .turbulence = 5});
  std::vector<WavePoint> points;
  for (std::int64_t i = 0; i < 4000; ++i) points.push_back({i * 5003 * plane_pixel, -i * 4001 * plane_pixel});
  std::vector<WavePoint> displaced(points.size());
  analysis.fixed->displace(Seed{7}, points, displaced);
  double mean[2] = {}, square[2] = {}, product = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double d[2] = {static_cast<double>(displaced[i].x - points[i].x) / plane_pixel,
                         static_cast<double>(displaced[i].y - points[i].y) / plane_pixel};
    for (int a = 0; a < 2; ++a) mean[a] += d[a] / 4000, square[a] += d[a] * d[a] / 4000;
    product += d[0] * d[1] / 4000;
  }
  for (int a = 0; a < 2; ++a) {
    EXPECT_NEAR(mean[a], 0, 0.07 * 5);
    EXPECT_NEAR(std::sqrt(square[a]), 5, 0.12 * 5);
  }
  EXPECT_NEAR(product / 25, 0, 0.08) << "the axes have numbers of their own";
}

/// A jump anywhere on a line that crosses many borders of blocks would be many times the steepest change elsewhere.
TEST(FixedPhases, AreContinuous) {
  for (const bool placement : {false, true}) {
    for (const double turbulence : {0.0, 4.0}) {
      const auto model = make_lrp(analysis_of({.ratio = 0.3, .turbulence = turbulence, .placement = placement}));
      constexpr int count = 40000;
      std::vector<Point2> points;
      points.reserve(count);
      for (int i = 0; i < count; ++i) points.push_back({-100 + i / 128.0, 3 + i / 301.0});
      std::vector<float> values(count), finer(count);
      model->procedural()->evaluate(points, Seed{3}, values);
      const auto steepest = [&](const std::vector<float>& v) {
        double most = 0;
        for (std::size_t i = 1; i < v.size(); ++i)
          most = std::max(most, std::abs(static_cast<double>(v[i] - v[i - 1])));
        return most;
      };
      // Around the steepest place, eight times as fine: what is continuous changes by less there.
      const double coarse = steepest(values);
      std::size_t at = 1;
      while (std::abs(static_cast<double>(values[at] - values[at - 1])) < coarse) ++at;
      const Point2 from = points[at - 1], to = points[at];
      for (int i = 0; i < count; ++i) {
        const double t = 1.0 / count * i;
        points[static_cast<std::size_t>(i)] = {from.x + t * (to.x - from.x), from.y + t * (to.y - from.y)};
      }
      model->procedural()->evaluate(points, Seed{3}, finer);
      EXPECT_LT(steepest(finer), 0.01 * coarse);
    }
  }
}

TEST(BoxResponse, IsTheMeanOfAWaveOverAPixel) {
  EXPECT_EQ(box_response(5, -7, 64, 0), 1);
  EXPECT_EQ(box_response(16, 0, 64, 4), 0) << "its first zero";
  EXPECT_EQ(box_response(0, 30, 64, 4), 0) << "and nothing beyond";
  double mean = 0;
  constexpr int n = 1000;
  for (int i = 0; i < n; ++i) mean += std::cos(2 * M_PI * 6 * ((i + 0.5) / n - 0.5) * 4 / 64) / n;
  EXPECT_NEAR(box_response(6, 0, 64, 4), mean, 1e-5);
  EXPECT_NEAR(box_response(6, 6, 64, 4), mean * mean, 1e-5);
}

/// Means over pixels of 2 x 2 by 12 x 12 points, of a structure and of a noise whose windows are wide.
TEST(Lrp, ClampedFrequenciesAreMeansOverPixels) {
  for (const double ratio : {0.0, 0.5}) {
    LrpOptions options = options_of({.ratio = ratio, .reduced = false});
    options.strata = {.strata = 1, .cosines = 4, .spacing = 20};
    const Exemplar exemplar = test_exemplar({80, 70}, 1);
    const auto sharp = make_lrp(analyze_lrp(exemplar, options, Seed{2}));
    options.footprint = 2;
    const auto filtered = make_lrp(analyze_lrp(exemplar, options, Seed{2}));
    constexpr int n = 12;
    double error = 0, power = 0;
    for (int i = 0; i < 200; ++i) {
      const Point2 at{7.3 * i, 100 - 3.1 * i};
      std::vector<Point2> points;
      for (int y = 0; y < n; ++y) {
        for (int x = 0; x < n; ++x) points.push_back({at.x - 1 + (x + 0.5) * 2 / n, at.y - 1 + (y + 0.5) * 2 / n});
      }
      std::vector<float> values(points.size());
      sharp->procedural()->evaluate(points, Seed{1}, values);
      double mean = 0;
      for (const float v : values) mean += static_cast<double>(v) / (n * n);
      float value = 0;
      filtered->procedural()->evaluate({&at, 1}, Seed{1}, {&value, 1});
      error += std::pow(value - mean, 2);
      power += std::pow(values.front() - 0.5, 2);
    }
    EXPECT_LT(std::sqrt(error / power), 0.02) << ratio;
  }
}

TEST(Structure, OfSmallBlocksNeedsAMipMap) {
  const LrpAnalysis analysis = analysis_of({.ratio = 0.5});
  const Structure& structure = analysis.fixed->structure;
  ASSERT_LE(structure.block_side(), 4) << "so few cosines need small blocks";
  const auto error_of = [&](const Structure& filtered) {
    double error = 0;
    constexpr int pixels = 16;
    for (int y = 0; y < 64; y += 3) {
      for (int x = 0; x < 64; x += 3) {
        double mean = 0;
        for (int j = 0; j < pixels; ++j) {
          for (int i = 0; i < pixels; ++i)
            mean += structure.image().at(0, (x + i) % 64, (y + j) % 64) / (pixels * pixels);
        }
        float value = 0;
        filtered.add({x * plane_pixel + pixels * plane_pixel / 2 - plane_pixel / 2,
                      y * plane_pixel + pixels * plane_pixel / 2 - plane_pixel / 2},
                     1, &value);
        error += std::pow(value - mean, 2);
      }
    }
    return std::sqrt(error);
  };
  EXPECT_LT(error_of(structure.filtered(16)), 0.6 * error_of(structure.filtered(16, false)));
  EXPECT_EQ(structure.filtered(16).block_side(), 8);
}

TEST(Lrp, TellsWhatItCannotServeOfStructures) {
  const auto fit = [](FixedPhaseOptions fixed, double footprint) {
    return [=] {
      LrpOptions options = options_of(fixed);
      options.footprint = footprint;
      analyze_lrp(test_exemplar({40, 40}, 1), options, Seed{1});
    };
  };
  for (const double ratio : {-0.1, 1.1, std::nan("")}) {
    EXPECT_THAT(fit({.ratio = ratio}, 0),
                ThrowsMessage<std::invalid_argument>(HasSubstr("of the power: expected a number from 0 to 1")));
  }
  EXPECT_THAT(fit({.ratio = 0.1, .turbulence = -1}, 0),
              ThrowsMessage<std::invalid_argument>(HasSubstr("turbulence = -1 pixels")));
  EXPECT_THAT(fit({}, INFINITY), ThrowsMessage<std::invalid_argument>(HasSubstr("footprint = inf pixels")));
  const auto model = make_lrp(analysis_of({.ratio = 0.2}));
  const Point2 origin{};
  float slopes[2];
  EXPECT_THAT(
      [&] {
        model->procedural()->gradient({&origin, 1}, Seed{1}, slopes);
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("expected structure = 0")));
}

}  // namespace
}  // namespace textonbench
