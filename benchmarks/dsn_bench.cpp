// Spot noise of RGB textons: time against domain, number of impacts and support, by each route, on one thread.
//
// `ratio_to_floor` is the time over that of a plain saxpy of MNI x pixels x channels floats in the L1 cache, measured
// turn by turn in this program: the arithmetic that direct summation cannot do without. `direct_over_spectral` tells
// which route is faster (the cost model of spot_sum.cpp is fitted to it), `auto_is` which one is chosen.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "benchmarks/timing.h"
#include "methods/spot/spot_noise.h"

namespace textonbench {
namespace {

constexpr int channels = 3;

Texton noise_texton(int side) {
  Texton texton;
  Image& kernel = texton.kernels.emplace_back(Extent{side, side}, channels);
  for (int c = 0; c < channels; ++c) {
    for (int y = 0; y < side; ++y) {
      fill_normal(Stream(Seed{1}).child(static_cast<std::uint64_t>(c)), static_cast<std::uint64_t>(y), 0,
                  kernel.row(c, y));
    }
  }
  texton.support_pixels = texton.extent().area();
  texton.mean = std::vector<double>(channels, 0.5);
  return texton;
}

/// to[i] += s from[i], n floats.
__attribute__((target_clones("default", "avx2", "avx512f"))) void saxpy(const float* from, float s, std::size_t n,
                                                                        float* to) {
  for (std::size_t i = 0; i < n; ++i) {
    to[i] += s * from[i];
  }
}

/// Seconds that saxpy takes for so many floats, from L1, by a sample of at most 2^26 of them.
double floor_seconds(double floats) {
  constexpr std::size_t chunk = 2048;
  static AlignedBuffer<float> from(chunk);
  static AlignedBuffer<float> to(chunk);
  from.set_zero();
  to.set_zero();
  const auto chunks = static_cast<std::int64_t>(std::ceil(std::min(floats, 0x1p26) / chunk));
  const double seconds = processor_seconds_of([&] {
    for (std::int64_t i = 0; i < chunks; ++i) {
      saxpy(from.data(), 0.5F, chunk, to.data());
      benchmark::ClobberMemory();
    }
  });
  return seconds * floats / static_cast<double>(chunks * std::int64_t{chunk});
}

double synthesis_seconds(const Model& model, const Domain& domain, std::uint64_t seed) {
  return processor_seconds_of([&] { benchmark::DoNotOptimize(model.synthesize(domain, Seed{seed}).plane(0)); });
}

struct Case {
  int domain, support;
  double mni;
  Impacts impacts = Impacts::poisson;
};

void routes(benchmark::State& state, const Case& it) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const Texton texton = noise_texton(it.support);
  const auto model = [&](SpotRoute route) {
    return make_spot_noise(texton, {.impacts = it.impacts, .mni = it.mni, .route = route});
  };
  const auto direct = model(SpotRoute::direct);
  const auto spectral = model(SpotRoute::spectral);
  const Domain domain{.size = {it.domain, it.domain}};
  const auto pixels = static_cast<double>(domain.size.area());
  std::vector<double> direct_seconds;
  std::vector<double> spectral_seconds;
  std::vector<double> floors;
  if (it.domain <= 1024) {
    synthesis_seconds(*spectral, domain, 0);  // plans
  }
  std::uint64_t seed = 1;
  while (state.KeepRunning()) {
    floors.push_back(floor_seconds(it.mni * pixels * channels));
    direct_seconds.push_back(synthesis_seconds(*direct, domain, seed));
    spectral_seconds.push_back(synthesis_seconds(*spectral, domain, seed));
    state.SetIterationTime(std::min(direct_seconds.back(), spectral_seconds.back()));
    ++seed;
  }
  const double of_direct = median(direct_seconds);
  const double of_spectral = median(spectral_seconds);
  state.counters["direct_ms"] = 1e3 * of_direct;
  state.counters["spectral_ms"] = 1e3 * of_spectral;
  state.counters["direct_over_spectral"] = of_direct / of_spectral;
  state.counters["ratio_to_floor"] = of_direct / median(floors);
  state.counters["ns_per_pixel"] = 1e9 * std::min(of_direct, of_spectral) / pixels;
  const double operations = model(SpotRoute::automatic)->footprint(domain).operations_per_pixel;
  const bool picks_direct = operations == direct->footprint(domain).operations_per_pixel;
  const double picked = picks_direct ? of_direct : of_spectral;
  state.SetLabel(picks_direct ? "auto: direct" : "auto: spectral");
  state.counters["auto_over_best"] = picked / std::min(of_direct, of_spectral);
}

/// A window of 64 x 64 far away against the same at the origin.
void window_of_a_large_domain(benchmark::State& state, Impacts impacts) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const auto model = make_spot_noise(noise_texton(31), {.impacts = impacts});
  const Domain near{.size = {64, 64}};
  const Domain far{.size = {64, 64}, .origin = {16000, 16000}};
  std::vector<double> near_seconds;
  std::vector<double> far_seconds;
  synthesis_seconds(*model, near, 0);
  std::uint64_t seed = 1;
  while (state.KeepRunning()) {
    near_seconds.push_back(synthesis_seconds(*model, near, seed));
    far_seconds.push_back(synthesis_seconds(*model, far, seed));
    state.SetIterationTime(far_seconds.back());
    ++seed;
  }
  state.counters["near_us"] = 1e6 * median(near_seconds);
  state.counters["far_us"] = 1e6 * median(far_seconds);
}

void register_case(const std::string& name, const Case& it) {
  const double work = it.mni * it.domain * it.domain;
  benchmark::RegisterBenchmark(name.c_str(), routes, it)
      ->Iterations(work < 1e7   ? 31
                   : work < 1e8 ? 9
                   : work < 1e9 ? 3
                                : 1)
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond);
}

void register_all() {
  for (const int domain : {128, 256, 512, 1024, 2048, 4096, 8192}) {
    register_case("domain/" + std::to_string(domain), {domain, 31, 30});
  }
  for (const int support : {15, 31, 64, 128, 256}) {
    for (const int mni : {5, 10, 20, 30, 50, 100, 300, 1000}) {
      register_case("support/" + std::to_string(support) + "/mni/" + std::to_string(mni),
                    {1024, support, static_cast<double>(mni)});
    }
  }
  for (const int mni : {3, 5, 30}) {
    register_case("stratified/mni/" + std::to_string(mni), {1024, 31, static_cast<double>(mni), Impacts::stratified});
  }
  benchmark::RegisterBenchmark("window_64/poisson", window_of_a_large_domain, Impacts::poisson)
      ->Iterations(200)
      ->UseManualTime()
      ->Unit(benchmark::kMicrosecond);
  benchmark::RegisterBenchmark("window_64/stratified", window_of_a_large_domain, Impacts::stratified)
      ->Iterations(200)
      ->UseManualTime()
      ->Unit(benchmark::kMicrosecond);
}

}  // namespace
}  // namespace textonbench

int main(int argc, char** argv) {
  textonbench::register_all();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
