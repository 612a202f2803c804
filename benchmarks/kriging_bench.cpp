// Kriging against the transforms that it needs, and its solvers against each other. One thread.
//
// iteration_over_transforms: seconds of an iteration of conjugate gradient over those of one FFTW r2c and one c2r
// transform a channel of the operator's grid, in double precision, planned with FFTW_MEASURE, measured turn by turn.
// Goal: at most 1.15.
//
// schwarz_over_cg: seconds of a solution to a relative residual of 1e-6 with the Schwarz preconditioner over those of
// plain conjugate gradient, on a hole of 100 x 100 in a picture of 256 x 256. Set-up is told apart. Goals: a fortieth,
// and at most 30 iterations. Of the exemplars named it needs TEXTONBENCH_DATA.
//
// inpaint_large: seconds of set-up and one sample of a picture of 2048 x 2048 with 5 % missing in one square, on all
// threads, to 1e-4. Goal: 120.
#include <benchmark/benchmark.h>
#include <fftw3.h>
#include <sys/resource.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "benchmarks/timing.h"
#include "methods/base/image_io.h"
#include "methods/base/masks.h"
#include "methods/conditional/inpainting.h"
#include "methods/spectral/adsn.h"

namespace textonbench {
namespace {

Image noise_picture(Extent extent, int channels) {
  Image image(extent, channels);
  for (int c = 0; c < channels; ++c) {
    for (int y = 0; y < extent.height; ++y) {
      fill_normal(Stream(Seed{1}).child(static_cast<std::uint64_t>(c)), static_cast<std::uint64_t>(y), 0,
                  image.row(c, y));
    }
  }
  return image;
}

/// One forward and one inverse transform of a raster in double precision, as plain FFTW code would make them.
class TransformPair {
 public:
  explicit TransformPair(Extent raster)
      : area_(static_cast<std::size_t>(raster.area())),
        pixels_(fftw_alloc_real(area_)),
        bins_(fftw_alloc_complex(static_cast<std::size_t>(raster.height) *
                                 static_cast<std::size_t>(raster.width / 2 + 1))),
        forward_(fftw_plan_dft_r2c_2d(raster.height, raster.width, pixels_, bins_, FFTW_MEASURE)),
        backward_(fftw_plan_dft_c2r_2d(raster.height, raster.width, bins_, pixels_, FFTW_MEASURE)) {
    std::fill(pixels_, pixels_ + area_, 0.0);  // stays zero however often it is transformed
  }
  TransformPair(const TransformPair&) = delete;
  TransformPair& operator=(const TransformPair&) = delete;
  ~TransformPair() {
    fftw_destroy_plan(forward_);
    fftw_destroy_plan(backward_);
    fftw_free(pixels_);
    fftw_free(bins_);
  }
  void run() {
    fftw_execute(forward_);
    fftw_execute(backward_);
  }

 private:
  std::size_t area_;
  double* pixels_;
  fftw_complex* bins_;
  fftw_plan forward_;
  fftw_plan backward_;
};

void iteration_over_transforms(benchmark::State& state, int channels) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const auto hole = static_cast<int>(state.range(0));
  const Extent size{hole + 40, hole + 40};
  Mask missing(size);
  for (int y = 0; y < hole; ++y) {
    for (int x = 0; x < hole; ++x) missing.set(20 + x, 20 + y, true);
  }
  constexpr int iterations = 20;
  const Inpainting model(noise_picture(size, channels), missing, nullptr,
                         {.solve = {.solver = KrigingSolver::cg, .tolerance = 0, .iterations = iterations}});
  const std::vector<double> right_side = model.right_side();
  TransformPair transforms(model.kriging_operator().covariance().grid());
  const auto solve = [&] { benchmark::DoNotOptimize(model.system().solve(right_side)); };
  const auto transform = [&] {
    // The solution's own residual is one more product.
    for (int i = 0; i < (iterations + 1) * channels; ++i) transforms.run();
  };
  solve();
  transform();
  std::vector<double> ours;
  std::vector<double> floor;
  for ([[maybe_unused]] const auto ignored : state) {
    ours.push_back(processor_seconds_of(solve));
    floor.push_back(processor_seconds_of(transform));
  }
  state.counters["grid"] = model.kriging_operator().covariance().grid().width;
  state.counters["ms"] = 1e3 * median(ours) / (iterations + 1);
  state.counters["ratio_to_transforms"] = median(ours) / median(floor);
}
BENCHMARK_CAPTURE(iteration_over_transforms, gray, 1)->Arg(100)->Arg(250)->Arg(500)->Arg(1000);
BENCHMARK_CAPTURE(iteration_over_transforms, color, 3)->Arg(100)->Arg(250)->Arg(500)->Arg(1000);

void schwarz_over_cg(benchmark::State& state, const char* exemplar) {
  const char* folder = std::getenv("TEXTONBENCH_DATA");
  const std::filesystem::path file = std::filesystem::path(folder == nullptr ? "" : folder) / exemplar;
  if (!std::filesystem::exists(file)) {
    state.SkipWithError("TEXTONBENCH_DATA does not name a folder with this exemplar");
    return;
  }
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const Image u = read_image(file).image;
  const Mask missing = make_mask("rect:78,78,100,100", 10, u.extent());
  const Inpainting plain(u, missing, nullptr, {.solve = {.solver = KrigingSolver::cg, .iterations = 5000}});
  std::vector<double> setup, schwarz_seconds, cg_seconds;
  SolveSummary by_schwarz, by_cg;
  for ([[maybe_unused]] const auto ignored : state) {
    const Inpainting model(u, missing, nullptr, {.solve = {.solver = KrigingSolver::schwarz}});
    by_schwarz = model.system().solve(model.right_side()).summary;
    by_cg = plain.system().solve(plain.right_side()).summary;
    setup.push_back(by_schwarz.setup_seconds);
    schwarz_seconds.push_back(by_schwarz.solve_seconds);
    cg_seconds.push_back(by_cg.solve_seconds);
  }
  state.counters["iterations"] = by_schwarz.iterations;
  state.counters["cg_iterations"] = by_cg.iterations;
  state.counters["setup_ms"] = 1e3 * median(setup);
  state.counters["solve_ms"] = 1e3 * median(schwarz_seconds);
  state.counters["ratio_to_cg"] = median(schwarz_seconds) / median(cg_seconds);
  state.counters["ratio_with_setup"] = (median(schwarz_seconds) + median(setup)) / median(cg_seconds);
}
BENCHMARK_CAPTURE(schwarz_over_cg, wood_256, "wood_256.png")->Iterations(5);
BENCHMARK_CAPTURE(schwarz_over_cg, blue_fabric2_crop, "blue_fabric2_crop.png")->Iterations(5);

/// ADSN of a texture of long correlations: products of two rows of smoothed noise.
void inpaint_large(benchmark::State& state, const char* mask) {
  Image base = noise_picture({256, 256}, 3);
  for (int c = 0; c < 3; ++c) {
    for (int pass = 0; pass < 3; ++pass) {
      for (int y = 0; y < 256; ++y) {
        for (int x = 0; x < 256; ++x) {
          base.at(c, x, y) = (base.at(c, x, y) + base.at(c, (x + 1) % 256, y) + base.at(c, x, (y + 1) % 256) +
                              base.at((c + 1) % 3, x, y) / 2) /
                             3;
        }
      }
    }
  }
  const Exemplar exemplar{"smooth noise", base, ""};
  const Image u = fit_adsn(exemplar, {})->synthesize({.size = {2048, 2048}}, Seed{1});
  const Mask missing = make_mask(mask, 5, u.extent());
  SolveSummary summary;
  std::vector<double> seconds;
  for ([[maybe_unused]] const auto ignored : state) {
    seconds.push_back(seconds_of([&] {
      const Inpainting model(u, missing, nullptr, {.solve = {.tolerance = 1e-4}});
      summary = model.sample(Seed{1}).summary;
    }));
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  state.counters["unknowns"] = static_cast<double>(summary.unknowns);
  state.counters["iterations"] = summary.iterations;
  state.counters["residual"] = summary.residual;
  state.counters["seconds"] = median(seconds);
  state.counters["peak_MB"] = static_cast<double>(usage.ru_maxrss) / 1e3;
}
BENCHMARK_CAPTURE(inpaint_large, square, "square")->Iterations(1)->Unit(benchmark::kSecond);
BENCHMARK_CAPTURE(inpaint_large, holes, "holes")->Iterations(1)->Unit(benchmark::kSecond);

}  // namespace
}  // namespace textonbench
BENCHMARK_MAIN();
