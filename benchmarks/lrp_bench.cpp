// Local random-phase noise against plain code and against the arithmetic that it cannot do without: default options (50
// cosines in 4 strata), RGB. One thread; processor time, measured turn by turn, medians. Exemplars that are files need
// TEXTONBENCH_DATA.
//
// raster: add_waves on 512 x 512 pixels. ratio_to_plain: nanoseconds a pixel of the plain loop (plain_waves.h), on 64 x
// 64 of those pixels and its cells drawn before, over those of ours; goal: at least 150. ratio_to_floor: seconds of
// ours over those of one fused multiply-add for each pixel, wave, channel and lattice point nearby (9 J C a pixel: two
// rows share the products of one, which would be two otherwise), made as fast as the processor can; goal: at most 2.5.
//
// points: sum_waves over the same plain loop, at 128 x 64 points that are neighbors of each other (row after row, half
// a pixel apart) and at 4096 that are scattered over 512 x 512 pixels. ratio_to_plain: goal at least 20.
//
// analysis: analyze_lrp of 256 x 256 pixels over the Welch spectrum and the strata (k-means) alone that it needs.
// Goals: 1 s, as in the paper, and 0.25 s.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <vector>

#include "benchmarks/fused_rate.h"
#include "benchmarks/plain_waves.h"
#include "benchmarks/timing.h"
#include "experiments/procedural_exemplars.h"
#include "methods/base/image_io.h"
#include "methods/sparse/lrp.h"
#include "methods/sparse/wave_raster.h"

namespace textonbench {
namespace {

constexpr Seed noise_seed{3};

/// A procedural exemplar or the picture of that name; none, and the benchmark is skipped, where its file is not at
/// hand.
std::optional<Exemplar> exemplar_of(benchmark::State& state, const char* name) {
  for (const ProceduralExemplar& one : procedural_exemplars()) {
    if (one.name == name) return Exemplar{name, draw_procedural(one.name, one.seed), ""};
  }
  const char* folder = std::getenv("TEXTONBENCH_DATA");
  const auto file = std::filesystem::path(folder == nullptr ? "" : folder) / (std::string(name) + ".png");
  if (!std::filesystem::exists(file)) {
    state.SkipWithError("TEXTONBENCH_DATA does not name a folder with this exemplar");
    return std::nullopt;
  }
  return Exemplar{name, read_image(file).image, ""};
}

/// The plain loop at all points, laid out as by sum_waves.
std::vector<float> plain_values(const WaveField& field, const PlainWaves& plain, const std::vector<WavePoint>& points) {
  const auto channels = static_cast<std::size_t>(field.channels);
  std::vector<float> all(channels * points.size()), one(channels);
  for (std::size_t i = 0; i < points.size(); ++i) {
    plain.at(points[i], one);
    for (std::size_t c = 0; c < channels; ++c) all[c * points.size() + i] = one[c];
  }
  return all;
}

/// The plain loop is sum_waves to 1e-4 standard deviations; skips the benchmark otherwise.
bool agrees(benchmark::State& state, const WaveField& field, const std::vector<WavePoint>& points,
            const std::vector<float>& plain) {
  std::vector<float> expected(plain.size());
  sum_waves(field, noise_seed, points, false, expected);
  double squares = 0, most = 0;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    squares += std::pow(expected[i], 2);
    most = std::max(most, std::abs(static_cast<double>(plain[i]) - static_cast<double>(expected[i])));
  }
  if (most <= 1e-4 * std::sqrt(squares / static_cast<double>(plain.size()))) return true;
  state.SkipWithError("the plain loop is not what sum_waves computes");
  return false;
}

/// Row after row, from (x, y) pixels on.
std::vector<WavePoint> raster_points(double x, double y, double step, Extent extent) {
  constexpr auto unit = static_cast<double>(std::int64_t{1} << plane_bits);
  std::vector<WavePoint> points;
  for (int j = 0; j < extent.height; ++j) {
    for (int i = 0; i < extent.width; ++i) {
      points.push_back({std::llround((x + step * i) * unit), std::llround((y + step * j) * unit)});
    }
  }
  return points;
}

void raster(benchmark::State& state, const char* name) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const auto exemplar = exemplar_of(state, name);
  if (!exemplar) return;
  const WaveField field = analyze_lrp(*exemplar, {}, Seed{1}).field;
  constexpr int side = 512, part = 64;
  constexpr double pixels = side * side;
  const std::vector<WavePoint> points = raster_points(200, 200, 1, {part, part});
  const PlainWaves plain(field, noise_seed, 200, 200, 200 + part, 200 + part);
  if (!agrees(state, field, points, plain_values(field, plain, points))) return;
  double products = 0;
  for (const WaveLayer& layer : field.layers) products += 9.0 * layer.waves() * field.channels * pixels;
  if (!make_fused(products)) {
    state.SkipWithError("no fused multiply-adds");
    return;
  }
  Image out({side, side}, field.channels);
  add_waves(field, noise_seed, {}, out);
  std::vector<double> ours, plains, floors;
  for ([[maybe_unused]] const auto ignored : state) {
    ours.push_back(processor_seconds_of([&] { add_waves(field, noise_seed, {}, out); }));
    floors.push_back(processor_seconds_of([&] { make_fused(products); }));
    plains.push_back(processor_seconds_of([&] { benchmark::DoNotOptimize(plain_values(field, plain, points)); }));
  }
  state.counters["ns_per_pixel"] = 1e9 * median(ours) / pixels;
  state.counters["plain_ns_per_pixel"] = 1e9 * median(plains) / (part * part);
  state.counters["floor_ns_per_pixel"] = 1e9 * median(floors) / pixels;
  state.counters["ratio_to_plain"] = median(plains) / (part * part) / (median(ours) / pixels);
  state.counters["ratio_to_floor"] = median(ours) / median(floors);
  state.counters["least_spacing"] = std::ranges::min(field.layers, {}, &WaveLayer::spacing).pixels();
}
BENCHMARK_CAPTURE(raster, oriented_lobe, "oriented_lobe")->Iterations(9);
BENCHMARK_CAPTURE(raster, power_law, "power_law")->Iterations(9);
BENCHMARK_CAPTURE(raster, wood_256, "wood_256")->Iterations(9);
BENCHMARK_CAPTURE(raster, HR_Cork, "HR_Cork")->Iterations(9);

void points(benchmark::State& state, const char* name, bool neighbors) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const auto exemplar = exemplar_of(state, name);
  if (!exemplar) return;
  const WaveField field = analyze_lrp(*exemplar, {}, Seed{1}).field;
  std::vector<WavePoint> points = raster_points(100, 100, 0.5, {128, 64});
  if (!neighbors) {
    RandomSequence numbers(Stream(Seed{9}).child("points"));
    points.resize(4096);
    for (WavePoint& point : points) {
      for (std::int64_t* at : {&point.x, &point.y}) {
        *at = static_cast<std::int64_t>(numbers.below(std::uint64_t{512} << plane_bits));
      }
    }
  }
  const PlainWaves plain(field, noise_seed, 0, 0, 512, 512);
  if (!agrees(state, field, points, plain_values(field, plain, points))) return;
  std::vector<float> out(points.size() * static_cast<std::size_t>(field.channels));
  std::vector<double> ours, plains;
  for ([[maybe_unused]] const auto ignored : state) {
    ours.push_back(processor_seconds_of([&] { sum_waves(field, noise_seed, points, false, out); }));
    plains.push_back(processor_seconds_of([&] { benchmark::DoNotOptimize(plain_values(field, plain, points)); }));
  }
  state.counters["ns_per_point"] = 1e9 * median(ours) / static_cast<double>(points.size());
  state.counters["plain_ns_per_point"] = 1e9 * median(plains) / static_cast<double>(points.size());
  state.counters["ratio_to_plain"] = median(plains) / median(ours);
}
BENCHMARK_CAPTURE(points, oriented_lobe_neighbors, "oriented_lobe", true)->Iterations(9);
BENCHMARK_CAPTURE(points, oriented_lobe_scattered, "oriented_lobe", false)->Iterations(9);
BENCHMARK_CAPTURE(points, wood_256_neighbors, "wood_256", true)->Iterations(9);
BENCHMARK_CAPTURE(points, wood_256_scattered, "wood_256", false)->Iterations(9);

void analysis(benchmark::State& state, const char* name) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const auto exemplar = exemplar_of(state, name);
  if (!exemplar) return;
  const LrpOptions options;
  const WelchSpectrum spectrum(exemplar->pixels, options.welch);
  PowerPlane plane(spectrum.side());
  for (const Pixel& bin : plane.half()) {
    plane.set(bin.x, bin.y, spectrum.power(bin.x, bin.y < 0 ? bin.y + spectrum.side() : bin.y));
  }
  std::vector<double> ours, welch, strata;
  for ([[maybe_unused]] const auto ignored : state) {
    ours.push_back(
        processor_seconds_of([&] { benchmark::DoNotOptimize(analyze_lrp(*exemplar, options, Seed{1}).field.layers); }));
    welch.push_back(
        processor_seconds_of([&] { benchmark::DoNotOptimize(WelchSpectrum(exemplar->pixels, options.welch).mean()); }));
    strata.push_back(processor_seconds_of(
        [&] { benchmark::DoNotOptimize(stratify(plane, options.strata, Stream(Seed{1}).child("lrp clusters"))); }));
  }
  state.counters["ms"] = 1e3 * median(ours);
  state.counters["welch_ms"] = 1e3 * median(welch);
  state.counters["strata_ms"] = 1e3 * median(strata);
  state.counters["ratio_to_parts"] = median(ours) / (median(welch) + median(strata));
}
BENCHMARK_CAPTURE(analysis, oriented_lobe, "oriented_lobe")->Iterations(9);
BENCHMARK_CAPTURE(analysis, wood_256, "wood_256")->Iterations(9);

}  // namespace
}  // namespace textonbench

BENCHMARK_MAIN();
