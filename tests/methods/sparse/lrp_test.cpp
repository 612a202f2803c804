// Local random-phase noise against its definition, and its law.
#include "methods/sparse/lrp.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "methods/sparse/wave_raster.h"
#include "methods/sparse/wave_spectrum.h"
#include "tests/methods/sparse/plain_wave_noise.h"
#include "tests/texture.h"

namespace textonbench {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

LrpOptions small_options() {
  LrpOptions options;
  options.strata = {.strata = 2, .cosines = 9, .kept = 1};
  return options;
}

LrpAnalysis small_analysis(int channels, const LrpOptions& options = small_options()) {
  return analyze_lrp(test_exemplar({40, 36}, channels), options, Seed{2});
}

double deviation(const WaveField& field) {
  double variance = 0;
  for (const Eigen::MatrixXd m = color_covariance(wave_spectrum(field, {64, 64})); int c : {0}) variance += m(c, c);
  return std::sqrt(variance);
}

std::vector<WavePoint> scattered_points(std::size_t count, double around, double at = 0) {
  RandomSequence numbers(Stream(Seed{9}).child("points"));
  std::vector<WavePoint> points;
  const auto coordinate = [&] {
    return static_cast<std::int64_t>((at + around * (numbers.uniform() - 0.5)) * (std::int64_t{1} << plane_bits));
  };
  for (std::size_t i = 0; i < count; ++i) {
    const std::int64_t x = coordinate();
    points.push_back({x, coordinate()});
  }
  return points;
}

TEST(SumWaves, IsTheDefinition) {
  for (const int channels : {1, 3}) {
    for (const bool even : {true, false}) {
      for (const LrpColor color : {LrpColor::coherent, LrpColor::independent}) {
        LrpOptions options = small_options();
        options.even_variance = even;
        options.color = color;
        const WaveField field = small_analysis(channels, options).field;
        const double sigma = deviation(field);
        for (const double at : {0.0, 1e11}) {
          const auto points = scattered_points(100, 60, at);
          const auto n = static_cast<std::size_t>(channels);
          std::vector<float> out(3 * n * points.size()), values(n * points.size());
          sum_waves(field, Seed{4}, points, true, out);
          sum_waves(field, Seed{4}, points, false, values);
          for (std::size_t i = 0; i < points.size(); ++i) {
            const auto expected = plain_waves(field, Seed{4}, points[i]);
            for (std::size_t c = 0; c < n; ++c) {
              EXPECT_EQ(values[c * points.size() + i], out[c * points.size() + i]);
              EXPECT_NEAR(out[c * points.size() + i], expected[c][0], 4e-6 * sigma);
              EXPECT_NEAR(out[(n + c) * points.size() + i], expected[c][1], 1e-4 * sigma);
              EXPECT_NEAR(out[(2 * n + c) * points.size() + i], expected[c][2], 1e-4 * sigma);
            }
          }
        }
      }
    }
  }
}

TEST(SumWaves, CountsNineWindowsAndNineTimesTheCosines) {
  for (const auto& [strata, cosines] : {std::pair{4, 50}, std::pair{1, 3}}) {
    LrpOptions options;
    options.strata = {.strata = strata, .cosines = cosines};
    const WaveField field = small_analysis(3, options).field;
    const auto points = scattered_points(77, 100);
    std::vector<float> out(3 * points.size());
    WaveCounts counts;
    sum_waves(field, Seed{1}, points, false, out, &counts);
    EXPECT_EQ(counts.windows, 77 * 9 * strata);
    EXPECT_EQ(counts.cosines, 77 * 9 * cosines);
  }
}

TEST(AddWaves, RasterOfAnyStepIsThePointsThemselves) {
  // Cells narrower than the steps, and wider than a tile.
  for (const auto& [channels, spacing] : {std::pair{1, 1.0}, {3, 1.0}, {8, 1.0}, {3, 4.0}, {3, 30.0}}) {
    LrpOptions options = small_options();
    options.strata.spacing = spacing;
    const WaveField field = small_analysis(channels, options).field;
    const double sigma = deviation(field);
    for (const WaveRaster& raster : {WaveRaster{0, 0, 1}, WaveRaster{-33.25, 17.5, 0.37}, WaveRaster{5, -400, 3},
                                     WaveRaster{1e11, -1e11, 1}, WaveRaster{2, 3, 100}}) {
      Image out({70, 81}, channels);
      add_waves(field, Seed{6}, raster, out);
      constexpr auto unit = static_cast<double>(std::int64_t{1} << plane_bits);
      std::vector<WavePoint> points;
      for (int y = 0; y < 81; ++y) {
        for (int x = 0; x < 70; ++x) {
          points.push_back({static_cast<std::int64_t>(std::floor((raster.x + raster.step * x) * unit)),
                            static_cast<std::int64_t>(std::floor((raster.y + raster.step * y) * unit))});
        }
      }
      std::vector<float> expected(points.size() * static_cast<std::size_t>(channels));
      sum_waves(field, Seed{6}, points, false, expected);
      for (int c = 0; c < channels; ++c) {
        for (int i = 0; i < 70 * 81; ++i) {
          ASSERT_NEAR(out.at(c, i % 70, i / 70), expected[static_cast<std::size_t>(c * 70 * 81 + i)], 1e-5 * sigma)
              << raster.step << " " << c << " " << i;
        }
      }
    }
  }
}

TEST(AddWaves, WindowsOfOneFieldHaveTheSameBits) {
  const WaveField field = small_analysis(3).field;
  for (const double far : {0.0, 1e12}) {
    for (const double step : {1.0, 0.25}) {
      Image a({150, 90}, 3), b({61, 70}, 3);
      add_waves(field, Seed{6}, {far - 20 * step, 7 * step, step}, a);
      add_waves(field, Seed{6}, {far + 57 * step, 18 * step, step}, b);
      for (int c = 0; c < 3; ++c) {
        for (int y = 0; y < 70; ++y) {
          for (int x = 0; x < 61; ++x) ASSERT_EQ(a.at(c, x + 77, y + 11), b.at(c, x, y)) << x << " " << y;
        }
      }
    }
  }
}

/// Strata keep their energy, so that colors have the exemplar's covariance wherever bins of a part share theirs, and
/// the sum of their variances exactly.
TEST(Lrp, HasTheVarianceOfItsSpectrum) {
  for (const int channels : {1, 3}) {
    for (const bool even : {true, false}) {
      for (const LrpColor color : {LrpColor::coherent, LrpColor::independent}) {
        LrpOptions options = small_options();
        options.even_variance = even;
        options.color = color;
        const LrpAnalysis analysis = small_analysis(channels, options);
        double expected = 0;
        const PowerPlane plane(analysis.spectrum.side());
        for (const Pixel& bin : plane.half()) {
          expected += plane.multiplicity(bin) *
                      analysis.spectrum.power(bin.x, bin.y < 0 ? bin.y + plane.side() : bin.y) /
                      (plane.side() * plane.side());
        }
        double variance = 0;
        const Autocovariance gamma = autocovariance(wave_spectrum(analysis.field, {160, 160}));
        // autocovariance() leaves frequency zero out.
        const CrossSpectrum p = wave_spectrum(analysis.field, {160, 160});
        for (int c = 0; c < channels; ++c) {
          variance += gamma.at(c, c, 0, 0);
          for (const Spectrum& factor : p.factors)
            variance += std::norm(std::complex<double>(factor.at(c, 0, 0))) / (160 * 160);
        }
        EXPECT_NEAR(variance, expected, 1e-4 * expected);
      }
    }
  }
}

/// Equation 3 as printed gives each layer a variance in proportion to that of its stratum over Δ².
TEST(Lrp, PrintedAmplitudesAttenuateWideWindows) {
  LrpOptions options = small_options();
  const LrpAnalysis corrected = small_analysis(1, options);
  options.amplitude = LrpAmplitude::printed;
  const LrpAnalysis printed = small_analysis(1, options);
  const auto variance = [](const WaveLayer& layer) {
    return static_cast<float>(layer.waves()) * std::norm(layer.color.front()) / 2;
  };
  const auto& a = corrected.field.layers;
  const auto& b = printed.field.layers;
  ASSERT_EQ(a.size(), 2U);
  EXPECT_NEAR(variance(a[0]) + variance(a[1]), variance(b[0]) + variance(b[1]), 1e-5 * variance(a[0]));
  EXPECT_NEAR(variance(b[0]) / variance(b[1]),
              variance(a[0]) / variance(a[1]) * std::pow(a[1].pixels() / a[0].pixels(), 2), 1e-4);
}

/// Waves of unequal parts have the variance of their own.
TEST(Lrp, PartsHaveTheVarianceOfTheBinsAroundThem) {
  LrpOptions options = small_options();
  options.amplitude = LrpAmplitude::parts;
  const LrpAnalysis analysis = small_analysis(1, options);
  for (std::size_t l = 0; l < analysis.layers.size(); ++l) {
    const Stratum& stratum = analysis.layers[l].stratum;
    const WaveLayer& layer = analysis.field.layers[l];
    for (std::size_t j = 0; j < stratum.parts.size(); ++j) {
      const double variance = std::norm(std::complex<double>(layer.color[layer.first[j]])) / 2;
      EXPECT_NEAR(variance, stratum.part_energy[j] / (32 * 32), 1e-5 * variance);
    }
  }
}

/// Excess kurtosis of the noise at a point: −3/(2J) of one sum of J cosines, times the mean of Σ v⁴ over the nine
/// windows v of unit sum of squares. 40000 independent values leave a standard error of at most sqrt(24 / 40000) =
/// 0.025; the test has a false alarm at 4.5 of them, below 1e-5.
TEST(Lrp, KurtosisIsThatOfFewCosines) {
  double fourth = 0;
  constexpr int n = 40;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      double squares = 0, fours = 0;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const double w =
              lrp_window(LrpWindow::bessel, std::hypot((i + 0.5) / n - 0.5 - dx, (j + 0.5) / n - 0.5 - dy));
          squares += w * w;
          fours += std::pow(w, 4);
        }
      }
      fourth += fours / (squares * squares) / (n * n);
    }
  }
  for (const int cosines : {1, 4}) {
    LrpOptions options;
    options.strata = {.strata = 1, .cosines = cosines};
    const WaveField field = small_analysis(1, options).field;
    double second = 0, four = 0;
    constexpr int values = 40000;
    const WavePoint origin[] = {{}};
    for (int s = 0; s < values; ++s) {
      float value = 0;
      sum_waves(field, derive(Seed{1}, static_cast<std::uint64_t>(s)), origin, false, {&value, 1});
      second += std::pow(value, 2) / values;
      four += std::pow(value, 4) / values;
    }
    EXPECT_NEAR(four / (second * second) - 3, -1.5 / cosines * fourth, 4.5 * 0.025) << cosines;
  }
}

/// The two limits of section 3: with one cosine of phase zero in its cell a window is a Gabor kernel (phase −f · x_i
/// from the origin), and far inside of a very wide cell the noise is a Fourier series, of nine sets of phases.
TEST(Lrp, LimitsAreGaborKernelsAndFourierSeries) {
  WaveField field{.channels = 1, .side_bits = 6, .window = LrpWindow::bessel, .even_variance = false, .layers = {}};
  WaveLayer layer;
  layer.spacing = std::int64_t{1000000} << plane_bits;
  layer.first = {0, 1, 2};
  layer.bins = {{3, 4}, {-5, 1}};
  layer.chance = {0xFFFFFFFFU, 0xFFFFFFFFU};
  layer.color = {1, 0.5};
  field.layers.push_back(layer);
  const WaveLattice lattice(field, 0, Seed{3});
  const WavePoint middle{lattice.center_x(0), lattice.center_y(0)};
  // Over a period of 64 pixels the envelope is constant to 64 / 10^6, so values repeat.
  std::vector<WavePoint> points;
  for (int i = 0; i < 40; ++i) {
    const std::int64_t x = middle.x + (std::int64_t{i} << plane_bits);
    points.push_back({x, middle.y});
    points.push_back({x + (std::int64_t{64} << plane_bits), middle.y - (std::int64_t{128} << plane_bits)});
  }
  std::vector<float> out(points.size());
  sum_waves(field, Seed{3}, points, false, out);
  for (std::size_t i = 0; i < points.size(); i += 2) EXPECT_NEAR(out[i], out[i + 1], 1e-3);
  // The nine cells' series, with the weights of the middle.
  for (std::size_t i = 0; i < points.size(); i += 2) {
    double expected = 0;
    const std::size_t pixel = i / 2;
    for (int cell_y = -1; cell_y <= 1; ++cell_y) {
      for (int cell_x = -1; cell_x <= 1; ++cell_x) {
        Wave waves[2];
        lattice.draw(cell_x, cell_y, waves);
        for (const Wave& wave : waves) {
          const double turns = wave.phase * 0x1p-32 + wave.bin.kx * static_cast<double>(pixel) / 64 -
                               (wave.bin.kx * cell_x + wave.bin.ky * cell_y) * 1e6 / 64;
          expected += lrp_window(LrpWindow::bessel, std::hypot(cell_x, cell_y)) *
                      static_cast<double>(wave.color->real()) * std::cos(2 * std::numbers::pi * turns);
        }
      }
    }
    EXPECT_NEAR(out[i], expected, 1e-3);
  }
}

TEST(Lrp, SharesPhasesAmongTheChannelsOfAGrayExemplar) {
  Exemplar gray = test_exemplar({40, 36}, 1);
  Exemplar same{"same", Image({40, 36}, 3), ""};
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < 36; ++y) std::ranges::copy(gray.pixels.row(0, y), same.pixels.row(c, y).begin());
  }
  const WaveField field = analyze_lrp(same, small_options(), Seed{2}).field;
  Image out({50, 40}, 3);
  add_waves(field, Seed{1}, {}, out);
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 50; ++x) {
      ASSERT_NEAR(out.at(0, x, y), out.at(1, x, y), 1e-6);
      ASSERT_NEAR(out.at(0, x, y), out.at(2, x, y), 1e-6);
    }
  }
}

TEST(Lrp, TellsWhatItCannotServe) {
  const auto fit = [](Extent size, const LrpOptions& options) {
    return [=] { analyze_lrp(test_exemplar(size, 1), options, Seed{1}); };
  };
  LrpOptions options;
  EXPECT_THAT(fit({31, 200}, options), ThrowsMessage<std::invalid_argument>(HasSubstr(
                                           "test_texture: lrp of 31x200 pixels: expected sides of at least 32")));
  options.strata.cosines = 3;
  EXPECT_THAT(fit({40, 40}, options), ThrowsMessage<std::invalid_argument>(HasSubstr("3 cosines in 4 strata")));
  options = {};
  for (const int side : {64, 24, 4}) {
    options.welch.side = side;
    EXPECT_THAT(fit({40, 50}, options),
                ThrowsMessage<std::invalid_argument>(HasSubstr("expected 0, or a power of two from 8 to 40")));
  }
  options = {};
  options.welch.overlap = 1;
  EXPECT_THAT(fit({40, 50}, options), ThrowsMessage<std::invalid_argument>(HasSubstr("overlap = 1")));
}

}  // namespace
}  // namespace textonbench
