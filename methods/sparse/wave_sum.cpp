#include "methods/sparse/wave_sum.h"

#include <cstddef>

#include "methods/sparse/wave_lanes.h"

namespace textonbench {
namespace {

using SumLanes = SixteenLanes;
constexpr int sum_width = SumLanes::count;

[[gnu::always_inline]] inline float sum_lanes(const SumLanes::Floats& v) {
  float s[sum_width / 2];
  for (int i = 0; i < sum_width / 2; ++i) s[i] = v[i] + v[i + sum_width / 2];
  for (int half = sum_width / 4; half >= 1; half /= 2) {
    for (int i = 0; i < half; ++i) s[i] += s[i + half];
  }
  return s[0];
}

template <bool slopes>
[[gnu::always_inline]] inline void sum_waves_of(const WavesAround& around, int channels, float a_bin, PointSums& sums) {
  using Floats = SumLanes::Floats;
  using Words = SumLanes::LooseWords;
  using Loose = SumLanes::LooseFloats;
  Floats value[Image::max_channels] = {};
  Floats slope_x[slopes ? Image::max_channels : 1] = {};
  Floats slope_y[slopes ? Image::max_channels : 1] = {};
  for (int i = 0; i < around.count; ++i) {
    const PaddedWaves& cell = around.waves[i];
    const float w = around.window[i];
    for (int first = 0; first < cell.padded; first += sum_width) {
      const auto kx = *reinterpret_cast<const Words*>(cell.kx + first);
      const auto ky = *reinterpret_cast<const Words*>(cell.ky + first);
      Floats cosine, sine;
      cos_sin_lanes<SumLanes>(
          kx * around.turn_x[i] + ky * around.turn_y[i] + *reinterpret_cast<const Words*>(cell.phase + first), cosine,
          sine);
      const float* color = cell.color + first;
      for (int c = 0; c < channels; ++c, color += std::ptrdiff_t{2} * cell.padded) {
        const Floats re = *reinterpret_cast<const Loose*>(color);
        const Floats im = *reinterpret_cast<const Loose*>(color + cell.padded);
        const Floats wave = re * cosine - im * sine;
        value[c] += w * wave;
        if constexpr (slopes) {
          const Floats turned = (w * a_bin) * (re * sine + im * cosine);
          const auto bins_x = __builtin_convertvector(reinterpret_cast<const SumLanes::Ints&>(kx), Floats);
          const auto bins_y = __builtin_convertvector(reinterpret_cast<const SumLanes::Ints&>(ky), Floats);
          slope_x[c] += around.slope_x[i] * wave - bins_x * turned;
          slope_y[c] += around.slope_y[i] * wave - bins_y * turned;
        }
      }
    }
  }
  for (int c = 0; c < channels; ++c) {
    sums.value[c] = sum_lanes(value[c]);
    if constexpr (slopes) {
      sums.slope_x[c] = sum_lanes(slope_x[c]);
      sums.slope_y[c] = sum_lanes(slope_y[c]);
    }
  }
}

}  // namespace

__attribute__((target_clones("default", "avx2", "avx512f"))) void sum_wave_values(const WavesAround& around,
                                                                                  int channels, PointSums& sums) {
  sum_waves_of<false>(around, channels, 0, sums);
}

__attribute__((target_clones("default", "avx2", "avx512f"))) void sum_wave_slopes(const WavesAround& around,
                                                                                  int channels, float a_bin,
                                                                                  PointSums& sums) {
  sum_waves_of<true>(around, channels, a_bin, sums);
}

}  // namespace textonbench
