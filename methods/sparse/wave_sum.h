// Sums of waves at one point.
#pragma once

#include <cstdint>

#include "methods/base/image.h"

namespace textonbench {

/// Waves that are padded to a multiple of 16 by waves of color zero: real parts of channel c from 2 c padded on,
/// imaginary parts `padded` later.
struct PaddedWaves {
  int padded = 0;
  const std::int32_t* kx = nullptr;
  const std::int32_t* ky = nullptr;
  const std::uint32_t* phase = nullptr;
  const float* color = nullptr;
};

constexpr int most_waves_around = 9;

/// The windowed waves that reach a point.
struct WavesAround {
  int count = 0;
  PaddedWaves waves[most_waves_around];
  std::uint32_t turn_x[most_waves_around];  ///< turns a bin from where the phases are to the point, 2^−32
  std::uint32_t turn_y[most_waves_around];
  float window[most_waves_around];
  float slope_x[most_waves_around];  ///< of the window, a pixel
  float slope_y[most_waves_around];
};

/// Σ window Σ_j Re(color exp(2πi (k · turn + phase))), by channel.
struct PointSums {
  float value[Image::max_channels];
  float slope_x[Image::max_channels];  ///< a pixel
  float slope_y[Image::max_channels];
};

void sum_wave_values(const WavesAround& around, int channels, PointSums& sums);
/// Slopes too; `a_bin` is 2π over the pixels that a bin's turn is one of.
void sum_wave_slopes(const WavesAround& around, int channels, float a_bin, PointSums& sums);

}  // namespace textonbench
