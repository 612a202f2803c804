// Time of each sample metric on one sample of 256 x 256 RGB (and 960 x 640), set up apart: `statistic` is what a run
// pays for every sample, `of_samples` what it pays once. The target's own torus, and a window of the plane.
#include <benchmark/benchmark.h>

#include <string>

#include "experiments/metrics/metric.h"

namespace textonbench {
namespace {

/// Independent channels, each white noise averaged over 3 x 3 pixels.
Exemplar noise_exemplar(Extent size) {
  Exemplar exemplar{"noise", Image(size, 3), {}};
  Image white({size.width + 2, size.height + 2}, 3);
  const Stream stream = Stream(Seed{1}).child("metrics_bench");
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < white.height(); ++y) {
      fill_normal(stream.child(static_cast<std::uint64_t>(c)), static_cast<std::uint64_t>(y), 0, white.row(c, y));
    }
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        float sum = 0;
        for (int j = 0; j < 3; ++j) {
          for (int i = 0; i < 3; ++i) sum += white.at(c, x + i, y + j);
        }
        exemplar.pixels.at(c, x, y) = 0.5F + 0.03F * sum;
      }
    }
  }
  return exemplar;
}

void time_statistic(benchmark::State& state, const MetricEntry& entry, const Domain& domain) {
  const Exemplar exemplar = noise_exemplar(domain.size);
  const Target target = make_target(exemplar);
  const auto metric = entry.of_samples(target, domain, Seed{1});
  while (state.KeepRunning()) benchmark::DoNotOptimize(metric->statistic(exemplar.pixels, domain));
}

void time_setup(benchmark::State& state, const MetricEntry& entry, const Domain& domain) {
  const Exemplar exemplar = noise_exemplar(domain.size);
  const Target target = make_target(exemplar);
  while (state.KeepRunning()) benchmark::DoNotOptimize(entry.of_samples(target, domain, Seed{1}));
}

void register_all() {
  for (const Extent size : {Extent{256, 256}, Extent{960, 640}}) {
    for (const bool periodic : {true, false}) {
      for (const MetricEntry& entry : metric_catalog()) {
        // Those that test theory need the exemplar's own torus.
        if (entry.level != MetricLevel::sample || (entry.identity && !periodic)) continue;
        const Domain domain{.size = size, .periodic = periodic};
        const std::string name = std::string(entry.name) + "/" + std::to_string(size.width) + "x" +
                                 std::to_string(size.height) + (periodic ? "/torus" : "/plane");
        benchmark::RegisterBenchmark(("statistic/" + name).c_str(), time_statistic, entry, domain)
            ->Unit(benchmark::kMillisecond)
            ->UseRealTime();
        benchmark::RegisterBenchmark(("of_samples/" + name).c_str(), time_setup, entry, domain)
            ->Unit(benchmark::kMillisecond)
            ->UseRealTime();
      }
    }
  }
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
