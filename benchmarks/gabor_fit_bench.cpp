// Analysis of Gabor noise by example, on one thread, on rasters of 128 x 128 bins in color (the paper took two
// minutes).
//
// pursuit: the whole fit, over the transforms of its iterations alone: of each window one forward and one inverse, and
//   one of the sum each way.
// mixture: merging and polishing 24 kernels, over the pursuit before.
// Goal: two seconds.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <vector>

#include "benchmarks/timing.h"
#include "experiments/procedural_exemplars.h"
#include "methods/base/image_io.h"
#include "methods/sparse/gabor_fit.h"

namespace textonbench {
namespace {

std::optional<GaborTarget> target_of(benchmark::State& state, const char* name) {
  for (const ProceduralExemplar& one : procedural_exemplars()) {
    if (one.name == name) return gabor_target({name, draw_procedural(one.name, one.seed), ""}, 128);
  }
  const char* folder = std::getenv("TEXTONBENCH_DATA");
  const auto file = std::filesystem::path(folder == nullptr ? "" : folder) / (std::string(name) + ".png");
  if (!std::filesystem::exists(file)) {
    state.SkipWithError("TEXTONBENCH_DATA does not name a folder with this exemplar");
    return std::nullopt;
  }
  return gabor_target({name, read_image(file).image, ""}, 128);
}

/// So many times the transforms of an iteration.
void transform(Extent raster, int windows, std::size_t iterations) {
  const Image coefficients(raster, windows), residual(raster, 1);
  const Spectrum all(raster, windows), one(raster, 1);
  for (std::size_t i = 0; i < iterations; ++i) {
    benchmark::DoNotOptimize(forward_fft(coefficients));
    benchmark::DoNotOptimize(inverse_fft(one));
    benchmark::DoNotOptimize(forward_fft(residual));
    benchmark::DoNotOptimize(inverse_fft(all));
  }
}

void pursuit(benchmark::State& state, const char* name) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const auto target = target_of(state, name);
  if (!target) return;
  const BandOptions bands{.bands = 6};
  const int windows = static_cast<int>(band_windows(target->raster(), bands).size());
  std::vector<double> ours, transforms;
  GaborFit fit;
  for ([[maybe_unused]] const auto ignored : state) {
    ours.push_back(processor_seconds_of([&] { fit = fit_pursuit(*target, bands, {.iterations = 4000}); }));
    transforms.push_back(processor_seconds_of([&] { transform(target->raster(), windows, fit.rme.size()); }));
  }
  state.counters["seconds"] = median(ours);
  state.counters["over_transforms"] = median(ours) / median(transforms);
  state.counters["iterations"] = static_cast<double>(fit.rme.size());
  state.counters["kernels"] = static_cast<double>(fit.kernels());
  state.counters["rme"] = fit.rme.back();
}

void mixture(benchmark::State& state, const char* name) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const auto target = target_of(state, name);
  if (!target) return;
  std::vector<double> before, ours;
  GaborFit fit;
  for ([[maybe_unused]] const auto ignored : state) {
    GaborFit start;
    before.push_back(processor_seconds_of([&] { start = fit_pursuit(*target, {.bands = 6}, {.iterations = 4000}); }));
    ours.push_back(processor_seconds_of([&] { fit = fit_mixture(*target, start, {.iterations = 100}); }));
  }
  state.counters["seconds"] = median(ours);
  state.counters["over_pursuit"] = median(ours) / median(before);
  state.counters["iterations"] = static_cast<double>(fit.rme.size());
  state.counters["kernels"] = static_cast<double>(fit.kernels());
  state.counters["rme"] = fit.rme.back();
}

BENCHMARK_CAPTURE(pursuit, oriented_lobe, "oriented_lobe")->Iterations(5)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(pursuit, fabric_2004, "fabric_2004")->Iterations(5)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(pursuit, wood_256, "wood_256")->Iterations(5)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(pursuit, moquette_10, "moquette_10")->Iterations(5)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(mixture, oriented_lobe, "oriented_lobe")->Iterations(3)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(mixture, fabric_2004, "fabric_2004")->Iterations(3)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(mixture, wood_256, "wood_256")->Iterations(3)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace textonbench

BENCHMARK_MAIN();
