// Gabor noise on one thread, RGB. Each case is measured beside the plain loop in the same run.
//
// plain: at each point the impacts around it are drawn, and each kernel that reaches it takes expf and sincosf, shared
// by
//   the channels, in floats: what a straightforward program does.
// raster: 512 x 512 pixels, also over the floor of two fused multiply-adds for each channel of a pixel of a kernel, at
//   the rate measured by fused_rate.h.
//   What it takes beyond the floor: vectors that reach over the rim of a kernel (three in ten lanes where its radius is
//   24 pixels, more in smaller ones), comparisons with the cut and sums that are loaded and stored for each kernel,
//   which are nearly half of the time of "directions"; columns and rows, a quarter; drawing, and adding tiles to the
//   picture. A skewed kernel has a power of two at each pixel besides.
// points: 65536 random points of the same square. A third of the time of "directions" is that of kernels; the rest is
//   sorting, choosing impacts and writing out of order.
// Goal: 20 times the plain loop.
//
// directions: one window, 64 directions. example: four windows of 0.02 to 0.16 a pixel, of ten impacts and 500 kernels
// of complex colors each. skewed: sixteen elliptic windows of axes 4 to 1 and five impacts each.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>
#include <vector>

#include "benchmarks/fused_rate.h"
#include "benchmarks/timing.h"
#include "methods/sparse/gabor.h"
#include "methods/sparse/gabor_sum.h"

namespace textonbench {
namespace {

constexpr Seed noise_seed{3};
constexpr int side = 512;
constexpr double side_pixels = static_cast<double>(side) * side;

double uniform(std::uint64_t number) { return philox_block(7, 0, number)[0] * 0x1p-32; }

GaborBand make_band(const GaborWindow& window, double mni, int kernels, std::uint64_t number) {
  GaborBand band;
  band.window = window;
  band.cell = std::sqrt(window.half_width() * window.half_height());
  band.intensity = ImpactGrid(ImpactProcess::stratified, mni / window.area(), band.cell, 1).intensity();
  std::vector<double> weights;
  for (int e = 0; e < kernels; ++e) {
    const std::uint64_t at = 1000 * number + static_cast<std::uint64_t>(e) * 8;
    band.frequency.push_back({uniform(at) - 0.5, uniform(at + 1) - 0.5});
    weights.push_back(uniform(at + 2));
    for (std::uint64_t c = 0; c < 3; ++c) {
      band.color.emplace_back(std::polar(1.0F, static_cast<float>(2 * std::numbers::pi * uniform(at + 3 + c))));
    }
  }
  band.draw_by(weights);
  return band;
}

GaborField make_field(std::string_view name) {
  GaborField field;
  field.channels = 3;
  if (name == "directions") {
    field = gabor_field({.frequency = 0.1, .bandwidth = 0.05});
    field.channels = 3;
    GaborBand& band = field.bands.front();
    band.color.resize(3 * band.frequency.size(), band.color.front());
  } else if (name == "example") {
    for (int b = 0; b < 4; ++b) {
      field.bands.push_back(
          make_band(GaborWindow::round(0.02 * (1 << b), 0.01), 10, 500, static_cast<std::uint64_t>(b)));
    }
  } else {
    for (int b = 0; b < 16; ++b) {
      const double turn = 2 * std::numbers::pi * b / 16, c = std::cos(turn), s = std::sin(turn);
      const double wide = 0.0009, narrow = 16 * wide;
      const GaborWindow window{.xx = wide * c * c + narrow * s * s,
                               .xy = (wide - narrow) * c * s,
                               .yy = wide * s * s + narrow * c * c,
                               .cut = 0.01};
      field.bands.push_back(make_band(window, 5, 1, static_cast<std::uint64_t>(b)));
    }
  }
  return field;
}

/// out[c * points.size() + i].
void sum_plainly(const GaborField& field, std::span<const WavePoint> points, std::vector<float>& out) {
  constexpr float pixel = 1.0F / plane_pixel;
  constexpr auto turn = static_cast<float>(2 * std::numbers::pi);
  std::ranges::fill(out, 0.0F);
  std::vector<GaborImpact> impacts;
  for (std::size_t b = 0; b < field.bands.size(); ++b) {
    const GaborBand& band = field.bands[b];
    GaborImpacts drawer(field, b, noise_seed);
    const auto reach_x = static_cast<std::int64_t>(std::ceil(band.window.half_width()) * plane_pixel);
    const auto reach_y = static_cast<std::int64_t>(std::ceil(band.window.half_height()) * plane_pixel);
    const auto xx = static_cast<float>(band.window.xx), xy = static_cast<float>(band.window.xy),
               yy = static_cast<float>(band.window.yy), limit = static_cast<float>(band.window.limit());
    for (std::size_t i = 0; i < points.size(); ++i) {
      impacts.clear();
      drawer.draw({points[i].x - reach_x, points[i].y - reach_y, points[i].x + reach_x, points[i].y + reach_y},
                  impacts);
      for (const GaborImpact& impact : impacts) {
        const float x = static_cast<float>(points[i].x - impact.x) * pixel;
        const float y = static_cast<float>(points[i].y - impact.y) * pixel;
        const float form = xx * x * x + 2 * xy * x * y + yy * y * y;
        if (form >= limit) continue;
        const float window = impact.weight * std::exp(-static_cast<float>(std::numbers::pi) * form);
        const GaborFrequency& f = band.frequency[impact.entry];
        const float angle = turn * (static_cast<float>(f.x) * x + static_cast<float>(f.y) * y +
                                    static_cast<float>(impact.phase) * 0x1p-32F);
        const float cosine = window * std::cos(angle), sine = window * std::sin(angle);
        const std::complex<float>* color = band.color.data() + std::size_t{3} * impact.entry;
        for (std::size_t c = 0; c < 3; ++c) {
          out[c * points.size() + i] += color[c].real() * cosine - color[c].imag() * sine;
        }
      }
    }
  }
}

std::vector<WavePoint> random_points(std::size_t count) {
  std::vector<WavePoint> points;
  points.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    points.push_back({static_cast<std::int64_t>(uniform(2 * i) * side * plane_pixel),
                      static_cast<std::int64_t>(uniform(2 * i + 1) * side * plane_pixel)});
  }
  return points;
}

/// Whether the two agree to 1e-4 of the field's size; if not the benchmark is an error.
bool agrees(benchmark::State& state, const std::vector<float>& ours, const std::vector<float>& plain) {
  double square = 0, most = 0;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    square += double{plain[i]} * plain[i] / static_cast<double>(plain.size());
    most = std::max(most, std::abs(double{ours[i]} - plain[i]));
  }
  // Kernels that one route cuts and the other does not, to rounding, are off by the cut.
  if (most <= 0.03 * std::sqrt(square)) return true;
  state.SkipWithError("the plain loop differs");
  return false;
}

void raster(benchmark::State& state, const char* name) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const GaborField field = make_field(name);
  std::vector<WavePoint> points;
  constexpr std::int64_t part = 64;
  points.reserve(static_cast<std::size_t>(part * part));
  for (std::int64_t i = 0; i < part * part; ++i) {
    points.push_back({(200 + i % part) * plane_pixel, (200 + i / part) * plane_pixel});
  }
  std::vector<float> plain(3 * points.size()), check(3 * points.size());
  sum_plainly(field, points, plain);
  sum_gabor(field, noise_seed, points, check);
  if (!agrees(state, check, plain)) return;
  double products = 0;
  for (const GaborBand& band : field.bands) products += 2 * band.intensity * band.window.area() * 3 * side_pixels;
  if (!make_fused(products)) {
    state.SkipWithError("no fused multiply-adds");
    return;
  }
  Image out({side, side}, 3);
  std::vector<double> ours, plains, floors;
  for ([[maybe_unused]] const auto ignored : state) {
    ours.push_back(processor_seconds_of([&] { add_gabor(field, noise_seed, {}, out); }));
    floors.push_back(processor_seconds_of([&] { make_fused(products); }));
    plains.push_back(processor_seconds_of([&] { sum_plainly(field, points, plain); }));
  }
  const double plain_pixel = median(plains) / static_cast<double>(points.size());
  state.counters["ns_per_pixel"] = 1e9 * median(ours) / side_pixels;
  state.counters["plain_ns_per_pixel"] = 1e9 * plain_pixel;
  state.counters["floor_ns_per_pixel"] = 1e9 * median(floors) / side_pixels;
  state.counters["ratio_to_plain"] = plain_pixel / (median(ours) / side_pixels);
  state.counters["ratio_to_floor"] = median(ours) / median(floors);
}

void points(benchmark::State& state, const char* name) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const GaborField field = make_field(name);
  const std::vector<WavePoint> all = random_points(65536), few = random_points(2048);
  std::vector<float> out(3 * all.size()), plain(3 * few.size()), check(3 * few.size());
  sum_plainly(field, few, plain);
  sum_gabor(field, noise_seed, few, check);
  if (!agrees(state, check, plain)) return;
  std::vector<double> ours, plains;
  for ([[maybe_unused]] const auto ignored : state) {
    ours.push_back(processor_seconds_of([&] { sum_gabor(field, noise_seed, all, out); }));
    plains.push_back(processor_seconds_of([&] { sum_plainly(field, few, plain); }));
  }
  const double plain_point = median(plains) / static_cast<double>(few.size());
  state.counters["ns_per_point"] = 1e9 * median(ours) / static_cast<double>(all.size());
  state.counters["plain_ns_per_point"] = 1e9 * plain_point;
  state.counters["ratio_to_plain"] = plain_point / (median(ours) / static_cast<double>(all.size()));
}

BENCHMARK_CAPTURE(raster, directions, "directions")->Iterations(5);
BENCHMARK_CAPTURE(raster, example, "example")->Iterations(5);
BENCHMARK_CAPTURE(raster, skewed, "skewed")->Iterations(5);
BENCHMARK_CAPTURE(points, directions, "directions")->Iterations(5);
BENCHMARK_CAPTURE(points, example, "example")->Iterations(5);
BENCHMARK_CAPTURE(points, skewed, "skewed")->Iterations(5);

}  // namespace
}  // namespace textonbench

BENCHMARK_MAIN();
