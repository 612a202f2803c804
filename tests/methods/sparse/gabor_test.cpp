// Gabor noise against its definition, and its law.
#include "methods/sparse/gabor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <numbers>

#include "methods/sparse/gabor_spectrum.h"
#include "methods/sparse/gabor_sum.h"
#include "tests/texture.h"

namespace textonbench {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// Three bands of unlike kernels, the last of them skewed, and complex colors.
GaborField test_field(int channels) {
  GaborField field = gabor_field({.frequency = 0.11, .orientation = 20, .directions = 3, .bandwidth = 0.06, .mni = 4});
  field.bands.push_back(gabor_field({.frequency = 0.3, .directions = 1, .bandwidth = 0.2, .mni = 6}).bands.front());
  field.bands.push_back(field.bands.back());
  field.bands.back().window = {.xx = 0.01, .xy = 0.012, .yy = 0.03, .cut = 0.02};
  field.channels = channels;
  for (GaborBand& band : field.bands) {
    band.color.clear();
    for (std::size_t e = 0; e < band.frequency.size(); ++e) {
      for (int c = 0; c < channels; ++c) band.color.emplace_back(0.3F + 0.1F * static_cast<float>(c), 0.2F);
    }
  }
  return field;
}

/// As it is written, in double precision and by libm.
std::vector<double> plain_gabor(const GaborField& field, Seed seed, const WavePoint& point) {
  std::vector<double> sum(static_cast<std::size_t>(field.channels));
  for (std::size_t b = 0; b < field.bands.size(); ++b) {
    const GaborBand& band = field.bands[b];
    const auto reach =
        static_cast<std::int64_t>((std::max(band.window.half_width(), band.window.half_height()) + 3) * plane_pixel);
    std::vector<GaborImpact> impacts;
    GaborImpacts(field, b, seed).draw({point.x - reach, point.y - reach, point.x + reach, point.y + reach}, impacts);
    for (const GaborImpact& impact : impacts) {
      const double x = static_cast<double>(point.x - impact.x) / plane_pixel;
      const double y = static_cast<double>(point.y - impact.y) / plane_pixel;
      if (band.window.form(x, y) >= band.window.limit()) continue;
      const double window = std::exp(-std::numbers::pi * band.window.form(x, y));
      const GaborFrequency& f = band.frequency[impact.entry];
      const double angle = 2 * std::numbers::pi * (f.x * x + f.y * y + impact.phase * 0x1p-32);
      for (int c = 0; c < field.channels; ++c) {
        const std::complex<double> color(
            band.color[impact.entry * static_cast<std::size_t>(field.channels) + static_cast<std::size_t>(c)]);
        sum[static_cast<std::size_t>(c)] +=
            static_cast<double>(impact.weight) * window * (color * std::polar(1.0, angle)).real();
      }
    }
  }
  return sum;
}

TEST(SumGabor, IsTheDefinition) {
  for (const int channels : {1, 3}) {
    const GaborField field = test_field(channels);
    for (const double at : {0.0, 1e11}) {
      std::vector<WavePoint> points;
      points.reserve(60);
      for (std::int64_t i = 0; i < 60; ++i) {
        points.push_back(
            {static_cast<std::int64_t>(at) * plane_pixel + i * i * plane_pixel / 7, -i * 13 * plane_pixel / 5});
      }
      std::vector<float> out(points.size() * static_cast<std::size_t>(channels));
      sum_gabor(field, Seed{4}, points, out);
      for (std::size_t i = 0; i < points.size(); ++i) {
        const auto expected = plain_gabor(field, Seed{4}, points[i]);
        for (std::size_t c = 0; c < expected.size(); ++c) {
          EXPECT_NEAR(out[c * points.size() + i], expected[c], 1e-5) << i << " " << c;
        }
      }
    }
  }
}

/// Kernels are cut at the same places by both.
TEST(AddGabor, RasterHasTheValuesOfThePoints) {
  const GaborField field = test_field(3);
  for (const WaveRaster& raster :
       {WaveRaster{0, 0, 1}, WaveRaster{-33.25, 17.5, 0.37}, WaveRaster{1e11, -1e11, 1}, WaveRaster{2, 3, 40}}) {
    Image out({70, 66}, 3);
    add_gabor(field, Seed{6}, raster, out);
    std::vector<WavePoint> points;
    points.reserve(4620);  // 70 x 66
    for (int y = 0; y < 66; ++y) {
      for (int x = 0; x < 70; ++x) {
        points.push_back({static_cast<std::int64_t>(std::floor((raster.x + raster.step * x) * plane_pixel)),
                          static_cast<std::int64_t>(std::floor((raster.y + raster.step * y) * plane_pixel))});
      }
    }
    std::vector<float> expected(3 * points.size());
    sum_gabor(field, Seed{6}, points, expected);
    for (int c = 0; c < 3; ++c) {
      for (int i = 0; i < 70 * 66; ++i) {
        ASSERT_NEAR(out.at(c, i % 70, i / 70), expected[static_cast<std::size_t>(c * 70 * 66 + i)], 5e-6)
            << raster.step;
      }
    }
  }
}

/// Points are grouped by squares of the plane, here crowded, far apart, and alone.
TEST(SumGabor, PointsDoNotDependOnEachOther) {
  const GaborField field = test_field(3);
  std::vector<WavePoint> points;
  points.reserve(332);
  for (std::int64_t i = 0; i < 300; ++i)
    points.push_back({i * 7919 % 40 * plane_pixel / 3, i * 104729 % 50 * plane_pixel / 7});
  for (std::int64_t i = 0; i < 30; ++i)
    points.push_back({(i - 15) * (plane_pixel << 34), (i * i - 99) * (plane_pixel << 27)});
  points.push_back({plane_pixel << 40, -plane_pixel << 40});
  points.push_back({-plane_pixel << 40, plane_pixel << 40});
  std::vector<float> together(3 * points.size()), alone(3);
  sum_gabor(field, Seed{8}, points, together);
  for (std::size_t i = 0; i < points.size(); ++i) {
    sum_gabor(field, Seed{8}, std::span(points).subspan(i, 1), alone);
    for (std::size_t c = 0; c < 3; ++c) ASSERT_EQ(alone[c], together[c * points.size() + i]) << i;
  }
}

/// Nor on their order, on the size of the call or on the number of threads.
TEST(SumGabor, PointsDoNotDependOnTheirOrder) {
  for (const int channels : {1, 2, 3, 4}) {
    const GaborField field = test_field(channels);
    constexpr std::size_t count = 9000;
    std::vector<WavePoint> points, other;
    points.reserve(count), other.reserve(count);
    for (std::uint64_t i = 0; i < count; ++i) {
      const auto words = philox_block(5, 0, i);
      points.push_back({std::int64_t{words[0]}, std::int64_t{words[1]} / 3});
    }
    const auto place = [](std::size_t i) { return i * 4999 % count; };
    for (std::size_t i = 0; i < count; ++i) other.push_back(points[place(i)]);
    std::vector<float> values(points.size() * static_cast<std::size_t>(channels)), others(values.size());
    {
      const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
      sum_gabor(field, Seed{2}, points, values);
    }
    const tbb::global_control two(tbb::global_control::max_allowed_parallelism, 2);
    sum_gabor(field, Seed{2}, other, others);
    for (std::size_t c = 0; c < static_cast<std::size_t>(channels); ++c) {
      for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(others[c * count + i], values[c * count + place(i)]) << i;
    }
  }
}

TEST(AddGabor, PixelsDoNotDependOnTheRaster) {
  for (const int channels : {1, 4}) {
    const GaborField field = test_field(channels);
    for (const double step : {0.5, 1.0, 3.0, 9.0}) {
      Image whole({300, 180}, channels), part({131, 40}, channels);
      add_gabor(field, Seed{3}, {-20, 7, step}, whole);
      add_gabor(field, Seed{3}, {-20 + 117 * step, 7 + 99 * step, step}, part);
      for (int c = 0; c < channels; ++c) {
        for (int y = 0; y < 40; ++y) {
          for (int x = 0; x < 131; ++x) ASSERT_EQ(part.at(c, x, y), whole.at(c, x + 117, y + 99)) << step;
        }
      }
    }
  }
}

/// ∫ g(y) g(y + v) dy on a grid of 1/16 pixel.
TEST(GaborCorrelation, IsTheIntegral) {
  for (const GaborWindow& window :
       {GaborWindow::round(0.15, 0.05), GaborWindow{.xx = 0.01, .xy = 0.012, .yy = 0.03, .cut = 0.02}}) {
    const GaborCorrelation correlation(window);
    for (const double s : {0.0, 2.0, 5.5, 9.0, 12.9}) {
      const double along = 0.6 * s, down = -0.8 * s;
      double sum = 0;
      constexpr int fine = 16;
      const int reach = static_cast<int>(fine * (window.half_width() + window.half_height() + s)) + 1;
      for (int j = -reach; j <= reach; ++j) {
        for (int i = -reach; i <= reach; ++i) {
          const double x = (i + 0.5) / fine, y = (j + 0.5) / fine;
          const double one = window.form(x, y), other = window.form(x + along, y + down);
          if (std::max(one, other) >= window.limit()) continue;
          sum += std::exp(-std::numbers::pi * (one + other)) / (fine * fine);
        }
      }
      EXPECT_NEAR(correlation.at(along, down), sum, 2e-3 * window.energy()) << s;
    }
    EXPECT_NEAR(correlation.at(0, 0), window.energy(), 1e-9);
    EXPECT_EQ(correlation.at(2.001 * window.half_width(), 0), 0);
  }
}

/// Entries are drawn as often as they say: 40000 draws of 3 % have a standard error of 0.00085, and the six of them
/// are off by 5 of them with a chance of 4e-6.
TEST(GaborBand, DrawsItsEntriesByTheirWeights) {
  GaborField field = gabor_field({.frequency = 0.2, .directions = 6, .bandwidth = 0.3});
  const std::vector<double> weights = {3, 0, 1, 0.03, 7, 0.5};
  GaborBand& band = field.bands.front();
  band.draw_by(weights);
  const std::vector<double> chance = band.chances();
  for (std::size_t e = 0; e < 6; ++e) EXPECT_NEAR(chance[e], weights[e] / 11.53, 1e-8);
  std::vector<GaborImpact> impacts;
  const auto side = static_cast<std::int64_t>(200 / std::sqrt(band.intensity)) * plane_pixel;
  GaborImpacts(field, 0, Seed{5}).draw({0, 0, side, side}, impacts);
  std::vector<double> share(6);
  for (const GaborImpact& impact : impacts) share[impact.entry] += 1 / static_cast<double>(impacts.size());
  ASSERT_GT(impacts.size(), 38000U);
  for (std::size_t e = 0; e < 6; ++e) {
    EXPECT_NEAR(share[e], chance[e], 5 * std::sqrt(chance[e] * (1 - chance[e]) / 38000)) << e;
  }
}

/// Entries on a raster are transformed, others are summed one by one.
TEST(GaborSpectrum, IsTheSameByTransformAndByEntry) {
  GaborField field = test_field(3);
  for (GaborBand& band : field.bands) {
    band.raster = {64, 48};
    for (std::size_t e = 0; e < band.frequency.size(); ++e) {
      band.frequency[e] = {static_cast<double>(e * 7) / 64 - 0.5, static_cast<double>(e * 5) / 48};
    }
  }
  GaborField plain = field;
  for (GaborBand& band : plain.bands) band.raster = {};
  const CrossSpectrum fast = gabor_spectrum(field, {100, 90}), slow = gabor_spectrum(plain, {100, 90});
  EXPECT_LT(relative_model_error(fast, slow), 1e-3) << "the root of what float leaves of a difference";
  EXPECT_LT((color_covariance(fast) - gabor_covariance(field)).norm(), 1e-4 * gabor_covariance(field).norm());
}

/// 10000 values far apart have a standard error of at most sqrt(3 / 10000) = 1.8 % of the variance, their excess
/// kurtosis being below 1: 15 tests have a false alarm at 4.5 of them with a chance of 1e-4.
TEST(Gabor, HasUnitVarianceForEveryPhaseWeightAndProcess) {
  std::vector<WavePoint> points;
  points.reserve(10000);
  for (std::int64_t i = 0; i < 10000; ++i) points.push_back({i % 100 * 97 * plane_pixel, i / 100 * 89 * plane_pixel});
  int laws = 0;
  for (const ImpactProcess process :
       {ImpactProcess::stratified, ImpactProcess::signed_poisson, ImpactProcess::poisson}) {
    for (const GaborPhase phase : {GaborPhase::random, GaborPhase::cosine, GaborPhase::sine}) {
      for (const GaborWeight weight : {GaborWeight::impacts, GaborWeight::uniform}) {
        // Low frequencies, so that phases matter, and kernels that are cut early.
        const GaborOptions options{.frequency = 0.03,
                                   .directions = 2,
                                   .bandwidth = 0.06,
                                   .cut = 0.1,
                                   .mni = 12,
                                   .process = process,
                                   .phase = phase,
                                   .weight = weight};
        if (refuse_gabor(options)) continue;
        ++laws;
        const GaborField field = gabor_field(options);
        EXPECT_NEAR(gabor_covariance(field)(0, 0), 1, 1e-6);
        std::vector<float> values(points.size());
        sum_gabor(field, Seed{static_cast<std::uint64_t>(laws)}, points, values);
        double mean = 0, second = 0;
        for (const float v : values) mean += static_cast<double>(v) / 10000, second += double{v} * v / 10000;
        EXPECT_NEAR(mean, 0, 4.5 * 0.01);
        EXPECT_NEAR(second, 1, 4.5 * 0.018) << laws;
      }
    }
  }
  EXPECT_EQ(laws, 16) << "but poisson impacts of one phase and weight 1";
}

/// Excess kurtosis of a Poisson process of random phases, (3/2) ∫ g⁴ / (λ (∫ g²)²). Its estimate from 40000 values
/// scatters by about sqrt(24 / 40000) of a normal law, some times that here: 0.1 leaves room for 4 of 0.025.
TEST(Gabor, KurtosisFallsWithTheImpacts) {
  std::vector<WavePoint> points;
  points.reserve(40000);
  for (std::int64_t i = 0; i < 40000; ++i) points.push_back({i % 200 * 61 * plane_pixel, i / 200 * 67 * plane_pixel});
  for (const double mni : {6.0, 20.0}) {
    const GaborField field = gabor_field(
        {.frequency = 0.2, .directions = 1, .bandwidth = 0.12, .mni = mni, .process = ImpactProcess::signed_poisson});
    std::vector<float> values(points.size());
    sum_gabor(field, Seed{3}, points, values);
    double second = 0, fourth = 0;
    for (const float v : values) second += double{v} * v / 40000, fourth += std::pow(double{v}, 4) / 40000;
    const GaborBand& band = field.bands.front();
    const double expected = 1.5 * band.window.fourth_moment() / (band.intensity * std::pow(band.window.energy(), 2));
    EXPECT_NEAR(fourth / (second * second) - 3, expected, 0.1) << mni;
  }
}

TEST(Gabor, TellsWhatItCannotServe) {
  const auto field = [](const GaborOptions& options) { return [=] { static_cast<void>(gabor_field(options)); }; };
  EXPECT_THAT(field({.frequency = 2}), ThrowsMessage<std::invalid_argument>(HasSubstr("2 cycles a pixel")));
  EXPECT_THAT(field({.directions = 0}), ThrowsMessage<std::invalid_argument>(HasSubstr("0 directions")));
  EXPECT_THAT(field({.bandwidth = 1e-4}), ThrowsMessage<std::invalid_argument>(HasSubstr("radius of 1 to 512")));
  EXPECT_THAT(field({.mni = 0}), ThrowsMessage<std::invalid_argument>(HasSubstr("expected 0.01 to 1000")));
  EXPECT_THAT(field({.process = ImpactProcess::poisson, .phase = GaborPhase::cosine}),
              ThrowsMessage<std::invalid_argument>(HasSubstr("its mean is not zero")));
}

}  // namespace
}  // namespace textonbench
