// RPN and ADSN against the inverse transforms that they cannot do without.
//
// Each row reports `ratio_to_floor`: seconds of a synthesis over seconds of the three inverse FFTW transforms alone,
// planned with FFTW_MEASURE, measured turn by turn on one thread, so that a slow moment of the machine falls on both.
#include <benchmark/benchmark.h>
#include <fftw3.h>
#include <tbb/global_control.h>

#include <vector>

#include "benchmarks/timing.h"
#include "methods/method.h"

namespace textonbench {
namespace {

Exemplar noise_exemplar(int side) {
  Exemplar exemplar{"noise", Image({side, side}, 3), ""};
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < side; ++y) {
      fill_normal(Stream(Seed{1}).child(static_cast<std::uint64_t>(c)), static_cast<std::uint64_t>(y), 0,
                  exemplar.pixels.row(c, y));
    }
  }
  return exemplar;
}

/// Three in-order c2r transforms of side x side, as plain FFTW code would make them.
class InverseFloor {
 public:
  explicit InverseFloor(int side) : bins_(static_cast<std::size_t>(side) * static_cast<std::size_t>(side / 2 + 1)) {
    for (int c = 0; c < 3; ++c) {
      in_[c] = fftwf_alloc_complex(bins_);
      out_[c] = fftwf_alloc_real(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
    }
    plan_ = fftwf_plan_dft_c2r_2d(side, side, in_[0], out_[0], FFTW_MEASURE | FFTW_DESTROY_INPUT);
    for (int c = 0; c < 3; ++c) {
      fill_normal(Stream(Seed{2}), static_cast<std::uint64_t>(c), 0, {reinterpret_cast<float*>(in_[c]), 2 * bins_});
    }
  }
  InverseFloor(const InverseFloor&) = delete;
  InverseFloor& operator=(const InverseFloor&) = delete;
  ~InverseFloor() {
    fftwf_destroy_plan(plan_);
    for (int c = 0; c < 3; ++c) {
      fftwf_free(in_[c]);
      fftwf_free(out_[c]);
    }
  }
  void run() {
    for (int c = 0; c < 3; ++c) {
      fftwf_execute_dft_c2r(plan_, in_[c], out_[c]);
    }
  }
  /// New numbers, since a transform overwrites its input and repeated ones would overflow.
  void refill() {
    for (int c = 0; c < 3; ++c) {
      fill_normal(Stream(Seed{2}), static_cast<std::uint64_t>(c), 0, {reinterpret_cast<float*>(in_[c]), 2 * bins_});
    }
  }

 private:
  std::size_t bins_;
  fftwf_complex* in_[3] = {};
  float* out_[3] = {};
  fftwf_plan plan_ = nullptr;
};

void synthesis_over_floor(benchmark::State& state, const char* method) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const int side = static_cast<int>(state.range(0));
  const Exemplar exemplar = noise_exemplar(side);
  const MethodEntry& entry = find_method(method);
  const auto model = entry.analyze({exemplar}, Params(entry.params, {}), Seed{1});
  const Domain domain{.size = {side, side}, .periodic = true};
  InverseFloor floor(side);
  std::vector<double> ours;
  std::vector<double> floors;
  benchmark::DoNotOptimize(model->synthesize(domain, Seed{0}));
  floor.run();
  std::uint64_t seed = 1;
  while (state.KeepRunning()) {
    floor.refill();
    const double floor_seconds = seconds_of([&] { floor.run(); });
    const double seconds =
        seconds_of([&] { benchmark::DoNotOptimize(model->synthesize(domain, Seed{seed++}).plane(0)); });
    ours.push_back(seconds);
    floors.push_back(floor_seconds);
    state.SetIterationTime(seconds);
  }
  state.counters["ratio_to_floor"] = median(ours) / median(floors);
  state.counters["ns_per_pixel"] = 1e9 * median(ours) / (static_cast<double>(side) * side);
  state.counters["floor_ms"] = 1e3 * median(floors);
}

BENCHMARK_CAPTURE(synthesis_over_floor, rpn, "rpn")
    ->Arg(256)
    ->Iterations(200)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(synthesis_over_floor, rpn_1024, "rpn")
    ->Arg(1024)
    ->Iterations(60)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(synthesis_over_floor, adsn_1024, "adsn")
    ->Arg(1024)
    ->Iterations(60)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(synthesis_over_floor, adsn_4096, "adsn")
    ->Arg(4096)
    ->Iterations(9)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace textonbench

BENCHMARK_MAIN();
