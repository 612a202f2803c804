// Gabor kernels in single precision.
//
// The logarithm of a window is a sum of two squares, −log2 g(y) = U² + V² with U = α y_1 + σ y_2 and V = β y_2 (α² =
// π xx / ln 2 and so on), and a place is inside where U² < limit − V². All routes find U, V and limit − V² by the same
// operations, so that all cut a kernel at the same places, bit for bit.
//
// Distances are exact: whole pixels as integers, and what is left of a pixel, in which a float is exact, by itself. So
// are turns, of 2^−32: a frequency's turns of a whole pixel are integers, that wrap around.
#pragma once

#include <cmath>
#include <complex>
#include <cstdint>
#include <vector>

#include "methods/sparse/gabor_field.h"
#include "methods/sparse/wave_points.h"

namespace textonbench {

/// A frequency along both axes: 2^−32 turn a whole pixel, and 2^−29 turn a part of one.
struct GaborTurns {
  std::uint32_t whole_x = 0, whole_y = 0;
  float part_x = 0, part_y = 0;
};

/// A band as kernels need it.
struct GaborShape {
  GaborShape(const GaborField& field, const GaborBand& band);

  /// Colors of an entry, by channel.
  const std::complex<float>* color(std::uint32_t entry) const {
    return colors + std::size_t{entry} * static_cast<std::size_t>(channels);
  }

  int channels = 1;
  float along = 0, shear = 0, across = 0;       ///< α, σ, β
  float limit = 0;                              ///< −log2 of the cut
  float cut = 0;                                ///< the cut
  double half_width = 0, half_height = 0;       ///< of the box around the window, pixels
  std::int64_t reach_x = 0, reach_y = 0;        ///< the same, 2^−22 pixel, rounded up
  double cell = 0;                              ///< about the side of a cell of impacts, pixels
  const std::complex<float>* colors = nullptr;  ///< of the band, which must outlive this
  std::vector<GaborTurns> turns;                ///< of each entry
};

/// An impact at whole pixels from some origin and parts of a pixel in [0, 1).
struct NearImpact {
  std::int32_t x = 0, y = 0;
  float part_x = 0, part_y = 0;
  float weight = 0;
  std::uint32_t phase = 0;
  std::uint32_t entry = 0;
};

/// Of a coordinate in 2^−22 pixel: its whole pixels, rounded down, and what is left, in pixels.
inline std::int64_t whole_pixels(std::int64_t at) { return at >> plane_bits; }
inline float part_of_pixel(std::int64_t at) {
  return static_cast<float>(at & (plane_pixel - 1)) * (1.0F / static_cast<float>(plane_pixel));
}

/// `origin_x` and `origin_y` in pixels, at most 2^30 from the impact.
inline NearImpact near_impact(const GaborImpact& impact, std::int64_t origin_x, std::int64_t origin_y) {
  return {static_cast<std::int32_t>(whole_pixels(impact.x) - origin_x),
          static_cast<std::int32_t>(whole_pixels(impact.y) - origin_y),
          part_of_pixel(impact.x),
          part_of_pixel(impact.y),
          impact.weight,
          impact.phase,
          impact.entry};
}

}  // namespace textonbench
