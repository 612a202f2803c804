// The inner loops of add_waves: the waves of one cell on the rows and columns of a tile.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

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

/// Writes z = color exp(2πi (k_x turns[x] + phase[j])) of each wave of a cell at columns c * count + x, and zero
/// beyond.
void fill_wave_columns(const WaveCell& cell, int channels, const std::uint32_t* phase, const std::uint32_t* turns,
                       int count, int columns, float* real, float* imaginary);

/// Cosines of 2π k_y turn, then sines, of a cell's waves, padded as they are.
void fill_wave_row(const WaveCell& cell, std::uint32_t turn, float* cosines_and_sines);

/// above[i] = Σ_j Re z_j cos_j − Im z_j sin_j and below[i] = Σ_j Re z_j cos_j + Im z_j sin_j for `pairs` pairs of rows:
/// pair p takes its cosines from rows[p * row_stride] on, its sines from `sines` later, and has above + p * columns and
/// below + p * columns. In fused multiply-adds, one wave after the other: the bits do not depend on the processor. One
/// that has no such instruction takes about a hundred times longer.
void sum_wave_rows(const WaveColumns& z, const float* rows, int row_stride, int sines, int pairs, float* above,
                   float* below);

/// Part of a row of a tile: sum[c * sum_stride + x] += w(x) from[c * from_stride + x] and squares[x] += w(x)², where
/// w(x) is the window at squared distance distance_x[x] + distance_y, in 2.25 squared spacings.
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
void add_windowed_row(const std::array<float, lrp_window_terms>& polynomial, const WindowedRow& row);

}  // namespace textonbench
