// Local random-phase noise at single points.
#pragma once

#include <span>
#include <vector>

#include "methods/sparse/wave_field.h"

namespace textonbench {

/// A pixel in plane units.
constexpr std::int64_t plane_pixel = std::int64_t{1} << plane_bits;

/// A point of the plane in 2^−22 pixel.
struct WavePoint {
  std::int64_t x = 0;
  std::int64_t y = 0;
};

/// Windows and cosines that were evaluated.
struct WaveCounts {
  std::int64_t windows = 0;
  std::int64_t cosines = 0;
};

/// out[c * points.size() + i] = n_c(points[i]), without the mean. With slopes, ∂n_c/∂x follows for all channels, then
/// ∂n_c/∂y, a pixel. Neighboring points are evaluated fastest: the waves of
/// 2048 cells are kept. A wave counts as one
/// cosine, whatever its channels.
void sum_waves(const WaveField& field, Seed seed, std::span<const WavePoint> points, bool slopes, std::span<float> out,
               WaveCounts* counts = nullptr);

}  // namespace textonbench
