#include "methods/spot/spline_cost.h"

#include <algorithm>
#include <cmath>

#include "methods/base/convolution.h"
#include "methods/spot/spline_place.h"
#include "methods/spot/spline_tile.h"

namespace textonbench {

// The nanoseconds are fitted to benchmarks/texton_noise_bench on one thread of a Zen 4 server with AVX-512 (1024²,
// supports of 16² to 256², orders 0 to 5, MNI 3 to 300), within 20 %; only their ratios matter.

SplineCost cost_by_point(const SplineTexton& texton, double intensity) {
  constexpr double tile = 16;
  constexpr double visit_nanoseconds = 0.9;
  constexpr double hit_nanoseconds = 0.3;
  constexpr double tap_nanoseconds = 0.27;
  const auto [width, height] = reach(texton);
  const int channels = texton.coefficients.channels();
  const double hits = intensity * width * height;
  const double visits = intensity * (width + tile) * (height + tile);
  const double taps = (texton.order + 1.0) * (texton.order + 1.0);
  const double vectors = channels <= 4 ? 1 : 2;
  return {hits * 2 * (taps + texton.order + 2) * channels,
          visits * visit_nanoseconds + hits * (hit_nanoseconds + tap_nanoseconds * taps * vectors)};
}

SplineCost cost_by_impact(const SplineTexton& texton, double intensity, const Domain& domain) {
  constexpr double impact_nanoseconds = 50;
  constexpr double cached_row_nanoseconds = 0.8;
  constexpr double uncached_row_nanoseconds = 1.25;
  constexpr double order_nanoseconds = 1.3;
  constexpr double cached_coefficients = 1 << 14;
  const auto [width, height] = reach(texton);
  const Extent kernel = texton.coefficients.extent();
  const int channels = texton.coefficients.channels();
  // Columns of impacts that reach the domain, over its own.
  const double reached = 1 + (width - 1.0) / domain.size.width;
  // Rows of tiles that a kernel meets on average over its places.
  const double rows =
      channels * (height + tile_height(texton.order) - 1.0) * (kernel.width + tile_width - 1.0) / tile_width;
  const double load =
      static_cast<double>(kernel.area()) <= cached_coefficients ? cached_row_nanoseconds : uncached_row_nanoseconds;
  const double row = std::max(load, order_nanoseconds * texton.order - cached_row_nanoseconds);
  return {intensity * width * height * channels * (5.0 * texton.order + 1),
          intensity * (reached * impact_nanoseconds + rows * row)};
}

SplineCost cost_by_convolution(const SplineTexton& texton, double intensity, const Domain& domain) {
  constexpr double operation_nanoseconds = 0.11;
  constexpr double impact_nanoseconds = 50;
  const int channels = texton.coefficients.channels();
  const auto pixels = static_cast<double>(convolution_grid(texton.coefficients.extent(), domain.size).area());
  // Transforms: of the impacts and of the channels of every kernel, and back for each channel.
  const double kernels = static_cast<double>(texton.coefficients.kernels.size());
  const double transforms = kernels * (1 + channels) + channels;
  const double operations = (transforms * 2.5 * std::log2(pixels) + 8 * kernels * channels) * pixels /
                            static_cast<double>(domain.size.area());
  const double taps = intensity * (texton.order + 1) * (texton.order + 1);
  return {operations + 2 * taps, operation_nanoseconds * operations + intensity * impact_nanoseconds + taps};
}

}  // namespace textonbench
