// The inner loops of add_waves: the waves of one cell on the rows and columns of a tile.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "methods/sparse/lrp_window.h"
#include "methods/sparse/wave_field.h"

namespace textonbench {

/// Columns of a matrix product are padded to whole lines of so many floats.
constexpr int wave_line = 16;

/// Columns of waves: of wave j, the real and imaginary parts of z are at [j * columns, (j + 1) * columns), `columns` a
/// multiple of wave_line.
struct WaveColumns {
  const float* real;
  const float* imaginary;
  int columns;
  int waves;
};

/// Vectors are whole: as many places beyond the last column must exist, whose values are finite and without meaning.
constexpr int wave_surplus = 16;
/// Greatest number of columns.
constexpr int most_wave_columns = 64;

/// Writes z = color exp(2πi (k_x turns[x] + phase)) of each wave at columns c * stride + x, x < count
/// <= stride.
void fill_wave_columns(std::span<const Wave> waves, int channels, const std::uint32_t* turns, int count, int stride,
                       int columns, float* real, float* imaginary);

/// For each turn the cosines of 2π k_y turn of all waves, then the sines. Waves are padded to a multiple of 8.
void fill_wave_rows(std::span<const std::int32_t> ky, std::span<const std::uint32_t> turns, float* cosines_and_sines);

/// above[i] = Σ_j Re z_j cos_j − Im z_j sin_j and below[i] = Σ_j Re z_j cos_j + Im z_j sin_j for `pairs` pairs of rows:
/// pair p takes its cosines from rows[p * row_stride] on, its sines from `sines` later, and has above + p * columns and
/// below + p * columns. In fused multiply-adds, one wave after the other: the bits do not depend on the processor. One
/// that has no such instruction takes about a hundred times longer.
void sum_wave_rows(const WaveColumns& z, const float* rows, int row_stride, int sines, int pairs, float* above,
                   float* below);

/// Part of a row of a tile: sum[c * sum_stride + x] += w(x) from[c * from_stride + x] and squares[x] += w(x)², x <
/// count, where w(x) is the window at squared distance distance_x[x] + distance_y, in 2.25 squared spacings: zero from
/// 1 on, as it must be in the surplus.
struct WindowedRow {
  const float* distance_x;
  float distance_y;
  int count;
  int channels;
  const float* from;
  std::ptrdiff_t from_stride;
  float* sum;
  std::ptrdiff_t sum_stride;
  float* squares;
};
/// All rows are of one cell.
void add_windowed_rows(const std::array<float, lrp_window_terms>& polynomial, std::span<const WindowedRow> rows);

}  // namespace textonbench
