#include "methods/sparse/wave_tile.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "methods/base/portable_math.h"

// One version an instruction set, chosen when the program is loaded; without fused instructions all have the same bits.
#define TEXTONBENCH_WAVE_SIMD __attribute__((target_clones("default", "avx2", "avx512f")))

namespace textonbench {
namespace {

/// Registers of floats, and the same anywhere in memory.
struct WideWaves {
  static constexpr int lanes = 16;
  using Floats = float __attribute__((vector_size(lanes * sizeof(float)), may_alias));
  using Loose = float __attribute__((vector_size(lanes * sizeof(float)), aligned(alignof(float)), may_alias));
};
struct NarrowWaves {
  static constexpr int lanes = 8;
  using Floats = float __attribute__((vector_size(lanes * sizeof(float)), may_alias));
  using Loose = float __attribute__((vector_size(lanes * sizeof(float)), aligned(alignof(float)), may_alias));
};

/// sum += weight line, rounded once, as the fused instruction of a processor that has it and by a function otherwise.
template <class Line, int... x>
[[gnu::always_inline]] inline void fuse(float weight, const typename Line::Floats& line, typename Line::Floats& sum,
                                        std::integer_sequence<int, x...>) {
  const auto w = typename Line::Floats{} + weight;
  const auto a = line;
  const auto b = sum;
  sum = typename Line::Floats{__builtin_fmaf(w[x], a[x], b[x])...};
}

/// `height` pairs of rows and `width` lines of columns, whose sums stay in registers.
template <class Line, int height, int width>
[[gnu::always_inline]] inline void sum_wave_block(const WaveColumns& z, int column, const float* rows, int row_stride,
                                                  int sines, float* above, float* below) {
  using Floats = typename Line::Floats;
  using Loose = typename Line::Loose;
  constexpr std::make_integer_sequence<int, Line::lanes> all{};
  Floats even[height][width] = {};
  Floats odd[height][width] = {};
  const float* real = z.real + column;
  const float* imaginary = z.imaginary + column;
  for (int j = 0; j < z.waves; ++j, real += z.columns, imaginary += z.columns) {
    Floats re[width], im[width];
#pragma GCC unroll 8
    for (int i = 0; i < width; ++i) {
      re[i] = *reinterpret_cast<const Loose*>(real + i * Line::lanes);
      im[i] = *reinterpret_cast<const Loose*>(imaginary + i * Line::lanes);
    }
#pragma GCC unroll 8
    for (int p = 0; p < height; ++p) {
      const float cosine = rows[p * row_stride + j];
      const float sine = rows[p * row_stride + sines + j];
#pragma GCC unroll 8
      for (int i = 0; i < width; ++i) {
        fuse<Line>(cosine, re[i], even[p][i], all);
        fuse<Line>(sine, im[i], odd[p][i], all);
      }
    }
  }
#pragma GCC unroll 8
  for (int p = 0; p < height; ++p) {
#pragma GCC unroll 8
    for (int i = 0; i < width; ++i) {
      const std::ptrdiff_t at = std::ptrdiff_t{p} * z.columns + column + i * Line::lanes;
      *reinterpret_cast<Loose*>(above + at) = even[p][i] - odd[p][i];
      *reinterpret_cast<Loose*>(below + at) = even[p][i] + odd[p][i];
    }
  }
}

template <class Line, int height, int width>
[[gnu::always_inline]] inline void sum_wave_strip(const WaveColumns& z, const float* rows, int row_stride, int sines,
                                                  float* above, float* below) {
  int column = 0;
  for (; column + width * Line::lanes <= z.columns; column += width * Line::lanes) {
    sum_wave_block<Line, height, width>(z, column, rows, row_stride, sines, above, below);
  }
  for (; column < z.columns; column += Line::lanes) {
    sum_wave_block<Line, height, 1>(z, column, rows, row_stride, sines, above, below);
  }
}

template <class Line, int height, int width>
[[gnu::always_inline]] inline void sum_wave_rows_of(const WaveColumns& z, const float* rows, int row_stride, int sines,
                                                    int pairs, float* above, float* below) {
  int p = 0;
  for (; p + height <= pairs; p += height) {
    const std::ptrdiff_t at = std::ptrdiff_t{p} * z.columns;
    sum_wave_strip<Line, height, width>(z, rows + p * row_stride, row_stride, sines, above + at, below + at);
  }
  for (; p < pairs; ++p) {
    const std::ptrdiff_t at = std::ptrdiff_t{p} * z.columns;
    sum_wave_strip<Line, 1, width>(z, rows + p * row_stride, row_stride, sines, above + at, below + at);
  }
}

__attribute__((target("avx512f"))) void sum_wave_rows_avx512(const WaveColumns& z, const float* rows, int row_stride,
                                                             int sines, int pairs, float* above, float* below) {
  sum_wave_rows_of<WideWaves, 4, 3>(z, rows, row_stride, sines, pairs, above, below);
}

__attribute__((target("avx2,fma"))) void sum_wave_rows_avx2(const WaveColumns& z, const float* rows, int row_stride,
                                                            int sines, int pairs, float* above, float* below) {
  sum_wave_rows_of<NarrowWaves, 2, 3>(z, rows, row_stride, sines, pairs, above, below);
}

}  // namespace

TEXTONBENCH_WAVE_SIMD void fill_wave_columns(const WaveCell& cell, int channels, const std::uint32_t* phase,
                                             const std::uint32_t* turns, int count, int columns, float* real,
                                             float* imaginary) {
  for (int j = 0; j < cell.waves; ++j, real += columns, imaginary += columns) {
    const auto k = static_cast<std::uint32_t>(cell.kx.data()[j]);
    const std::uint32_t start = phase[j];
    constexpr int line = 64;
    for (int first = 0; first < count; first += line) {
      alignas(64) float cosine[line], sine[line];
      const int here = std::min(line, count - first);
      for (int x = 0; x < here; ++x) portable::cos_sin(k * turns[first + x] + start, cosine[x], sine[x]);
      for (int c = 0; c < channels; ++c) {
        const float re = cell.color.data()[2 * c * cell.padded + j];
        const float im = cell.color.data()[(2 * c + 1) * cell.padded + j];
        float* to_real = real + c * count + first;
        float* to_imaginary = imaginary + c * count + first;
        for (int x = 0; x < here; ++x) {
          to_real[x] = re * cosine[x] - im * sine[x];
          to_imaginary[x] = re * sine[x] + im * cosine[x];
        }
      }
    }
    std::fill(real + channels * count, real + columns, 0.0F);
    std::fill(imaginary + channels * count, imaginary + columns, 0.0F);
  }
}

TEXTONBENCH_WAVE_SIMD void fill_wave_row(const WaveCell& cell, std::uint32_t turn, float* cosines_and_sines) {
  const std::int32_t* k = cell.ky.data();
  float* cosine = cosines_and_sines;
  float* sine = cosines_and_sines + cell.padded;
  for (int j = 0; j < cell.padded; ++j) {
    portable::cos_sin(static_cast<std::uint32_t>(k[j]) * turn, cosine[j], sine[j]);
  }
}

void sum_wave_rows(const WaveColumns& z, const float* rows, int row_stride, int sines, int pairs, float* above,
                   float* below) {
  if (__builtin_cpu_supports("avx512f")) {
    sum_wave_rows_avx512(z, rows, row_stride, sines, pairs, above, below);
  } else if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    sum_wave_rows_avx2(z, rows, row_stride, sines, pairs, above, below);
  } else {
    sum_wave_rows_of<NarrowWaves, 1, 1>(z, rows, row_stride, sines, pairs, above, below);
  }
}

TEXTONBENCH_WAVE_SIMD void add_windowed_row(const std::array<float, lrp_window_terms>& polynomial,
                                            const WindowedRow& row) {
  constexpr int most = 64;
  alignas(64) float window[most];
  for (int first = 0; first < row.count; first += most) {
    const int here = std::min(most, row.count - first);
    for (int x = 0; x < here; ++x) {
      const float t = std::max(0.0F, 1 - row.distance_x[first + x] - row.distance_y);
      float p = polynomial[lrp_window_terms - 1];
      for (int m = lrp_window_terms - 2; m >= 0; --m) p = p * t + polynomial[static_cast<std::size_t>(m)];
      window[x] = t * std::sqrt(t) * p;
    }
    for (int x = 0; x < here; ++x) row.squares[first + x] += window[x] * window[x];
    for (int c = 0; c < row.channels; ++c) {
      const float* from = row.from + c * row.from_stride + first;
      float* sum = row.sum + c * row.sum_stride + first;
      for (int x = 0; x < here; ++x) sum[x] += window[x] * from[x];
    }
  }
}

}  // namespace textonbench
