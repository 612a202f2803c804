// Texton noise of order 1 in RGB: routes against each other, against the scalar loop of the paper and against the
// Fourier transforms of the convolution, measured turn by turn in one program. Times are of the processor, on one
// thread but for the rows "threads".
//
//   scalar_over_*      how many times longer the scalar loop takes, per pixel, with the same impacts' process
//   *_over_fftw        against four plain FFTW transforms of the padded raster (the impacts', and one a channel back)
//   impacts_over_floor against the plain arithmetic, 8 operations a pixel, channel and impact at the rate at which
//                      saxpy runs from the L1 cache; tiles keep their sums in registers and go below it
//   auto_over_best     the route that the cost model picks over the fastest one
#include <benchmark/benchmark.h>
#include <fftw3.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <string>
#include <vector>

#include "benchmarks/scalar_texton_noise.h"
#include "methods/base/fft.h"
#include "methods/spot/spline_noise.h"

namespace textonbench {
namespace {

constexpr int channels = 3;

/// Processor time, all work being on one thread, so that other programs on the machine disturb it little.
double seconds_of(const auto& work) {
  const std::clock_t start = std::clock();
  work();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

double wall_seconds_of(const auto& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

/// White coefficients whose kernels cover side x side pixels.
SplineTexton noise_texton(int side, int order = 1) {
  SplineTexton texton;
  texton.order = order;
  Image& kernel = texton.coefficients.kernels.emplace_back(Extent{side - order, side - order}, channels);
  for (int c = 0; c < channels; ++c) {
    for (int y = 0; y < kernel.height(); ++y) {
      fill_normal(Stream(Seed{1}).child(static_cast<std::uint64_t>(c)), static_cast<std::uint64_t>(y), 0,
                  kernel.row(c, y));
    }
  }
  texton.coefficients.support_pixels = kernel.extent().area();
  texton.coefficients.mean = std::vector<double>(channels, 0.5);
  texton.support_area = static_cast<double>(side) * side;
  return texton;
}

double synthesis_seconds(const Model& model, int side, std::uint64_t seed) {
  return seconds_of([&] { benchmark::DoNotOptimize(model.synthesize({.size = {side, side}}, Seed{seed}).plane(0)); });
}

/// The impacts' process of a model with cells of 0.6 sides, for the scalar loop.
ImpactGrid grid_of(ImpactProcess process, int support, double mni) {
  return {process, mni / (static_cast<double>(support) * support), 0.6 * support, 1};
}

double scalar_seconds_per_pixel(const SplineTexton& texton, const ImpactGrid& grid, std::uint64_t key) {
  constexpr int side = 96;
  const ScalarTextonNoise scalar(texton, grid, key);
  return seconds_of([&] { benchmark::DoNotOptimize(scalar.draw(side).plane(0)); }) / (side * side);
}

/// One transform forward and three back of a raster that holds the domain and a kernel.
class FftwFloor {
 public:
  explicit FftwFloor(int minimum)
      : side_(good_fft_size(minimum)),
        raster_(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_)),
        bins_(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_ / 2 + 1)) {
    forward_ = fftwf_plan_dft_r2c_2d(side_, side_, raster_.data(), complex(), FFTW_MEASURE | FFTW_PRESERVE_INPUT);
    back_ = fftwf_plan_dft_c2r_2d(side_, side_, complex(), raster_.data(), FFTW_MEASURE | FFTW_DESTROY_INPUT);
    raster_.set_zero();
  }
  FftwFloor(const FftwFloor&) = delete;
  FftwFloor& operator=(const FftwFloor&) = delete;
  ~FftwFloor() {
    fftwf_destroy_plan(forward_);
    fftwf_destroy_plan(back_);
  }
  double seconds() {
    return seconds_of([&] {
      fftwf_execute(forward_);
      for (int c = 0; c < channels; ++c) {
        fftwf_execute(back_);
      }
    });
  }

 private:
  fftwf_complex* complex() { return reinterpret_cast<fftwf_complex*>(bins_.data()); }

  int side_;
  AlignedBuffer<float> raster_;
  AlignedBuffer<std::complex<float>> bins_;
  fftwf_plan forward_ = nullptr;
  fftwf_plan back_ = nullptr;
};

/// to[i] += s from[i], n floats.
__attribute__((target_clones("default", "avx2", "avx512f"))) void saxpy(const float* from, float s, std::size_t n,
                                                                        float* to) {
  for (std::size_t i = 0; i < n; ++i) {
    to[i] += s * from[i];
  }
}

/// Seconds that saxpy takes for so many floats, from L1, by a sample of 2^25 of them.
double saxpy_seconds(double floats) {
  constexpr std::size_t chunk = 2048;
  constexpr int chunks = 1 << 14;
  static AlignedBuffer<float> from(chunk);
  static AlignedBuffer<float> to(chunk);
  from.set_zero();
  to.set_zero();
  const double seconds = seconds_of([&] {
    for (int i = 0; i < chunks; ++i) {
      saxpy(from.data(), 0.5F, chunk, to.data());
      benchmark::ClobberMemory();
    }
  });
  return seconds * floats / static_cast<double>(chunk * chunks);
}

struct Case {
  int domain, support;
  double mni;
  ImpactProcess impacts = ImpactProcess::poisson;
  int order = 1;
};

void routes(benchmark::State& state, const Case& it) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const SplineTexton texton = noise_texton(it.support, it.order);
  const auto model = [&](SplineRoute route) {
    return make_spline_noise(texton, {.impacts = it.impacts, .mni = it.mni, .route = route});
  };
  const SplineRoute all[] = {SplineRoute::points, SplineRoute::impacts, SplineRoute::convolution};
  const char* names[] = {"points_ns", "impacts_ns", "convolution_ns"};
  std::vector<std::unique_ptr<Model>> models;
  for (const SplineRoute route : all) {
    models.push_back(model(route));
  }
  const auto pixels = static_cast<double>(it.domain) * it.domain;
  std::vector<double> seconds[3];
  std::vector<double> scalars;
  std::vector<double> fftws;
  std::vector<double> floors;
  FftwFloor fftw(it.domain + it.support - 2);
  const ImpactGrid grid = grid_of(it.impacts, it.support, it.mni);
  std::uint64_t seed = 1;
  synthesis_seconds(*models[2], it.domain, 0);  // plans
  while (state.KeepRunning()) {
    for (std::size_t r = 0; r < 3; ++r) {
      seconds[r].push_back(synthesis_seconds(*models[r], it.domain, seed));
    }
    fftws.push_back(fftw.seconds());
    floors.push_back(4 * saxpy_seconds(it.mni * pixels * channels));
    if (it.order == 1) {
      scalars.push_back(pixels * scalar_seconds_per_pixel(texton, grid, seed));
    }
    state.SetIterationTime(seconds[1].back());
    ++seed;
  }
  double best = median(seconds[0]);
  std::size_t picked = 0;
  const Domain domain{.size = {it.domain, it.domain}};
  const double operations = model(SplineRoute::automatic)->footprint(domain).operations_per_pixel;
  for (std::size_t r = 0; r < 3; ++r) {
    state.counters[names[r]] = 1e9 * median(seconds[r]) / pixels;
    best = std::min(best, median(seconds[r]));
    picked = operations == models[r]->footprint(domain).operations_per_pixel ? r : picked;
  }
  state.SetLabel(std::string("auto: ") + std::string(names[picked]).substr(0, std::string(names[picked]).size() - 3));
  state.counters["auto_over_best"] = median(seconds[picked]) / best;
  state.counters["impacts_over_fftw"] = median(seconds[1]) / median(fftws);
  state.counters["convolution_over_fftw"] = median(seconds[2]) / median(fftws);
  state.counters["impacts_over_floor"] = median(seconds[1]) / median(floors);
  if (it.order == 1) {
    state.counters["scalar_over_points"] = median(scalars) / median(seconds[0]);
    state.counters["scalar_over_impacts"] = median(scalars) / median(seconds[1]);
  }
}

/// Five stratified impacts against thirty of the paper: point by point against its scalar loop, by impact against
/// Poisson impacts.
void stratified_against_paper(benchmark::State& state) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const int support = static_cast<int>(state.range(0));
  const SplineTexton texton = noise_texton(support);
  const auto by = [&](ImpactProcess process, double mni, SplineRoute route) {
    return make_spline_noise(texton, {.impacts = process, .mni = mni, .route = route});
  };
  const auto points = by(ImpactProcess::stratified, 5, SplineRoute::points);
  const auto impacts = by(ImpactProcess::stratified, 5, SplineRoute::impacts);
  const auto poisson = by(ImpactProcess::poisson, 30, SplineRoute::impacts);
  const ImpactGrid paper = grid_of(ImpactProcess::paper, support, 30);
  std::vector<double> of_points;
  std::vector<double> of_impacts;
  std::vector<double> of_poisson;
  std::vector<double> of_paper;
  constexpr int side = 1024;
  std::uint64_t seed = 1;
  while (state.KeepRunning()) {
    of_points.push_back(synthesis_seconds(*points, side, seed));
    of_impacts.push_back(synthesis_seconds(*impacts, side, seed));
    of_poisson.push_back(synthesis_seconds(*poisson, side, seed));
    of_paper.push_back(side * side * scalar_seconds_per_pixel(texton, paper, seed));
    state.SetIterationTime(of_points.back());
    ++seed;
  }
  state.counters["points_ns"] = 1e9 * median(of_points) / (side * side);
  state.counters["paper_ns"] = 1e9 * median(of_paper) / (side * side);
  state.counters["paper_over_points"] = median(of_paper) / median(of_points);
  state.counters["impacts_over_poisson"] = median(of_impacts) / median(of_poisson);
}

/// Wall time of a 1024 x 1024 raster on two threads. The paper's Quadro K5000 took 4.9 ms for a texton of 64.
void threads(benchmark::State& state, ImpactProcess process, double mni) {
  const tbb::global_control two_threads(tbb::global_control::max_allowed_parallelism, 2);
  const auto model = make_spline_noise(noise_texton(64), {.impacts = process, .mni = mni});
  std::uint64_t seed = 1;
  while (state.KeepRunning()) {
    state.SetIterationTime(wall_seconds_of([&] {
      benchmark::DoNotOptimize(model->synthesize({.size = {1024, 1024}}, Seed{seed++}).plane(0));
    }));
  }
}

/// Points far from each other against the side of the cells, in percent of the support's.
void single_points(benchmark::State& state) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const auto cell = static_cast<double>(state.range(1)) / 100;
  const auto model = make_spline_noise(noise_texton(64), {.mni = static_cast<double>(state.range(0)), .cell = cell});
  std::vector<Point2> points;
  points.reserve(4000);
  for (int i = 0; i < 4000; ++i) {
    points.push_back({1000.0 * (i % 63), 777.7 * i});
  }
  std::vector<float> out(channels * points.size());
  while (state.KeepRunning()) {
    const double seconds = seconds_of([&] { model->procedural()->evaluate(points, Seed{1}, out); });
    state.SetIterationTime(seconds / static_cast<double>(points.size()));
  }
}

void register_case(const std::string& name, const Case& it, int iterations) {
  benchmark::RegisterBenchmark(name.c_str(), routes, it)
      ->Iterations(iterations)
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond);
}

void register_all() {
  for (const int support : {16, 32, 64, 128, 256}) {
    register_case("texton/" + std::to_string(support), {1024, support, 30}, 5);
  }
  for (const int mni : {3, 10, 100, 300}) {
    register_case("mni/" + std::to_string(mni), {1024, 64, static_cast<double>(mni)}, 3);
  }
  for (const int domain : {128, 512, 2048}) {
    register_case("domain/" + std::to_string(domain), {domain, 64, 30}, domain < 512 ? 15 : 3);
  }
  for (const int order : {0, 2, 3, 5}) {
    register_case("order/" + std::to_string(order), {1024, 64, 30, ImpactProcess::poisson, order}, 3);
  }
  register_case("stratified/5", {1024, 64, 5, ImpactProcess::stratified}, 5);
  benchmark::RegisterBenchmark("stratified_against_paper", stratified_against_paper)
      ->Arg(32)
      ->Arg(64)
      ->Arg(256)
      ->Iterations(5)
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("threads/poisson/30", threads, ImpactProcess::poisson, 30.0)
      ->Iterations(31)
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("threads/stratified/5", threads, ImpactProcess::stratified, 5.0)
      ->Iterations(31)
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("single_points", single_points)
      ->ArgNames({"mni", "cell"})
      ->ArgsProduct({{5, 30, 200}, {10, 20, 30, 40, 60, 80, 100, 160}})
      ->Iterations(9)
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
