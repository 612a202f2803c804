#include "methods/sparse/wave_tile.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "methods/sparse/wave_lanes.h"

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
    sum_wave_strip<Line, height, width>(z, rows + std::ptrdiff_t{p} * row_stride, row_stride, sines, above + at,
                                        below + at);
  }
  for (; p < pairs; ++p) {
    const std::ptrdiff_t at = std::ptrdiff_t{p} * z.columns;
    sum_wave_strip<Line, 1, width>(z, rows + std::ptrdiff_t{p} * row_stride, row_stride, sines, above + at, below + at);
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

template <class Lanes>
[[gnu::always_inline]] inline void fill_columns_of(std::span<const Wave> waves, int channels,
                                                   const std::uint32_t* turns, int count, int stride, int columns,
                                                   float* real, float* imaginary) {
  using Floats = typename Lanes::Floats;
  using Loose = typename Lanes::LooseFloats;
  for (const Wave& wave : waves) {
    const auto k = static_cast<std::uint32_t>(wave.bin.kx);
    const std::uint32_t phase = wave.phase;
    // From the right: the surplus of a channel's last block falls on the next channel's first one, which comes later.
    const std::complex<float>* color = wave.color;
    for (int first = (count - 1) / Lanes::count * Lanes::count; first >= 0; first -= Lanes::count) {
      Floats cosine, sine;
      cos_sin_lanes<Lanes>(*reinterpret_cast<const typename Lanes::LooseWords*>(turns + first) * k + phase, cosine,
                           sine);
      for (int c = 0; c < channels; ++c) {
        const float re = color[c].real(), im = color[c].imag();
        const Floats a = re * cosine - im * sine;
        const Floats b = re * sine + im * cosine;
        *reinterpret_cast<Loose*>(real + std::ptrdiff_t{c} * stride + first) = a;
        *reinterpret_cast<Loose*>(imaginary + std::ptrdiff_t{c} * stride + first) = b;
      }
    }
    real += columns;
    imaginary += columns;
  }
}

template <class Lanes>
[[gnu::always_inline]] inline void add_windowed_row_of(const std::array<float, lrp_window_terms>& polynomial,
                                                       const WindowedRow& row) {
  using Floats = typename Lanes::Floats;
  using Loose = typename Lanes::LooseFloats;
  static_assert(lrp_window_terms == 9);
  const auto& k = polynomial;
  const WindowedRow r = row;
  for (int first = 0; first < r.count; first += Lanes::count) {
    Floats t = 1 - *reinterpret_cast<const Loose*>(r.distance_x + first) - r.distance_y;
    t = t > 0 ? t : Floats{};
    const Floats t2 = t * t, t4 = t2 * t2;
    const Floats p =
        ((k[0] + k[1] * t) + t2 * (k[2] + k[3] * t)) + t4 * (((k[4] + k[5] * t) + t2 * (k[6] + k[7] * t)) + t4 * k[8]);
    Floats root;
    for (int x = 0; x < Lanes::count; ++x) root[x] = std::sqrt(t[x]);
    const Floats window = t * root * p;
    *reinterpret_cast<Loose*>(r.squares + first) += window * window;
    const float* from = r.from + first;
    float* sum = r.sum + first;
    for (int c = 0; c < r.channels; ++c, from += r.from_stride, sum += r.sum_stride) {
      *reinterpret_cast<Loose*>(sum) += window * *reinterpret_cast<const Loose*>(from);
    }
  }
}

TEXTONBENCH_WAVE_SIMD void add_narrow_rows(const std::array<float, lrp_window_terms>& polynomial,
                                           std::span<const WindowedRow> rows) {
  for (const WindowedRow& row : rows) add_windowed_row_of<EightLanes>(polynomial, row);
}

TEXTONBENCH_WAVE_SIMD void add_wide_rows(const std::array<float, lrp_window_terms>& polynomial,
                                         std::span<const WindowedRow> rows) {
  for (const WindowedRow& row : rows) add_windowed_row_of<SixteenLanes>(polynomial, row);
}

TEXTONBENCH_WAVE_SIMD void fill_narrow_columns(std::span<const Wave> waves, int channels, const std::uint32_t* turns,
                                               int count, int stride, int columns, float* real, float* imaginary) {
  fill_columns_of<EightLanes>(waves, channels, turns, count, stride, columns, real, imaginary);
}

TEXTONBENCH_WAVE_SIMD void fill_wide_columns(std::span<const Wave> waves, int channels, const std::uint32_t* turns,
                                             int count, int stride, int columns, float* real, float* imaginary) {
  fill_columns_of<SixteenLanes>(waves, channels, turns, count, stride, columns, real, imaginary);
}

}  // namespace

void fill_wave_columns(std::span<const Wave> waves, int channels, const std::uint32_t* turns, int count, int stride,
                       int columns, float* real, float* imaginary) {
  (count <= EightLanes::count ? fill_narrow_columns : fill_wide_columns)(waves, channels, turns, count, stride, columns,
                                                                         real, imaginary);
}

TEXTONBENCH_WAVE_SIMD void fill_wave_rows(std::span<const std::int32_t> ky, std::span<const std::uint32_t> turns,
                                          float* cosines_and_sines) {
  const auto padded = static_cast<std::ptrdiff_t>(ky.size());
  float* to = cosines_and_sines;
  for (const std::uint32_t turn : turns) {
    for (std::ptrdiff_t j = 0; j < padded; j += EightLanes::count) {
      const auto k = *reinterpret_cast<const EightLanes::LooseWords*>(ky.data() + j);
      EightLanes::Floats cosine, sine;
      cos_sin_lanes<EightLanes>(k * turn, cosine, sine);
      *reinterpret_cast<EightLanes::LooseFloats*>(to + j) = cosine;
      *reinterpret_cast<EightLanes::LooseFloats*>(to + padded + j) = sine;
    }
    to += 2 * padded;
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

void add_windowed_rows(const std::array<float, lrp_window_terms>& polynomial, std::span<const WindowedRow> rows) {
  if (rows.empty()) return;
  (rows.front().count <= EightLanes::count ? add_narrow_rows : add_wide_rows)(polynomial, rows);
}

}  // namespace textonbench
