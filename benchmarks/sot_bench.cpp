// Alternating projections against the full FFTW transforms that they replace.
//
// Each row reports `ratio_to_full`: seconds of 50 iterations over seconds of 50 forward and 50 inverse transforms a
// channel of the whole raster, planned with FFTW_MEASURE, measured turn by turn on one thread. Goals: 0.7 at 128 x 128
// with a support of 32, 0.85 at 768 x 512 with one of 256.
#include <benchmark/benchmark.h>
#include <fftw3.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <vector>

#include "benchmarks/timing.h"
#include "methods/spot/alternating_projections.h"

namespace textonbench {
namespace {

constexpr int iterations = 50;

Image noise_image(Extent extent, int channels) {
  Image image(extent, channels);
  for (int c = 0; c < channels; ++c) {
    for (int y = 0; y < extent.height; ++y) {
      fill_normal(Stream(Seed{1}).child(static_cast<std::uint64_t>(c)), static_cast<std::uint64_t>(y), 0,
                  image.row(c, y));
    }
  }
  return image;
}

/// r2c and c2r transforms of the whole raster, back and forth, as plain FFTW code would make them.
class FullTransforms {
 public:
  FullTransforms(Extent raster, int channels)
      : channels_(channels),
        area_(static_cast<std::size_t>(raster.area())),
        pixels_(fftwf_alloc_real(area_)),
        bins_(fftwf_alloc_complex(static_cast<std::size_t>(raster.height) *
                                  static_cast<std::size_t>(raster.width / 2 + 1))),
        forward_(fftwf_plan_dft_r2c_2d(raster.height, raster.width, pixels_, bins_, FFTW_MEASURE)),
        backward_(fftwf_plan_dft_c2r_2d(raster.height, raster.width, bins_, pixels_, FFTW_MEASURE)) {
    std::fill(pixels_, pixels_ + area_, 0.0F);  // stays zero however often it is transformed
  }
  FullTransforms(const FullTransforms&) = delete;
  FullTransforms& operator=(const FullTransforms&) = delete;
  ~FullTransforms() {
    fftwf_destroy_plan(forward_);
    fftwf_destroy_plan(backward_);
    fftwf_free(pixels_);
    fftwf_free(bins_);
  }
  void run() {
    for (int i = 0; i < iterations * channels_; ++i) {
      fftwf_execute(forward_);
      fftwf_execute(backward_);
    }
  }

 private:
  int channels_;
  std::size_t area_;
  float* pixels_;
  fftwf_complex* bins_;
  fftwf_plan forward_;
  fftwf_plan backward_;
};

void projections_over_full_transforms(benchmark::State& state, Extent raster, int channels, int side, int order) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const GaussianModel model = gaussian_model(noise_image(raster, channels));
  const Support support = square_support(side);
  const Spectrum start = random_phase_start(model.spectrum.factors.front(), Seed{1});
  FullTransforms full(raster, channels);
  const auto project = [&] {
    benchmark::DoNotOptimize(alternate_projections(model, support, start, {.iterations = iterations, .order = order}));
  };
  project();
  full.run();
  std::vector<double> ours;
  std::vector<double> theirs;
  while (state.KeepRunning()) {
    theirs.push_back(seconds_of([&] { full.run(); }));
    ours.push_back(seconds_of(project));
    state.SetIterationTime(ours.back());
  }
  state.counters["ratio_to_full"] = median(ours) / median(theirs);
  state.counters["full_ms"] = 1e3 * median(theirs);
}

BENCHMARK_CAPTURE(projections_over_full_transforms, rgb_128_support_31, Extent{128, 128}, 3, 31, 0)
    ->Iterations(31)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(projections_over_full_transforms, gray_128_support_31, Extent{128, 128}, 1, 31, 0)
    ->Iterations(31)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(projections_over_full_transforms, rgb_128_whole, Extent{128, 128}, 3, 128, 0)
    ->Iterations(31)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(projections_over_full_transforms, rgb_768x512_support_256, Extent{768, 512}, 3, 256, 0)
    ->Iterations(5)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

// The coefficients of linear splines, as texton noise is analyzed.
BENCHMARK_CAPTURE(projections_over_full_transforms, linear_rgb_128_support_32, Extent{128, 128}, 3, 32, 1)
    ->Iterations(31)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(projections_over_full_transforms, linear_rgb_768x512_support_256, Extent{768, 512}, 3, 256, 1)
    ->Iterations(5)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace textonbench

BENCHMARK_MAIN();
