// The inner loops of add_waves: the waves of one cell on the pixels of a tile.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "methods/base/aligned_buffer.h"
#include "methods/sparse/lrp_window.h"
#include "methods/sparse/wave_field.h"
#include "methods/sparse/wave_table.h"

namespace textonbench {

/// Side of a tile in pixels.
constexpr int wave_tile_side = 128;
/// Vectors are whole: as many places behind the last one exist, whose values are finite and without meaning.
constexpr int wave_surplus = 16;

/// The pixels [first, first + count) of a tile along an axis, those that a cell's window reaches.
struct TileReach {
  std::int64_t cell = 0;
  int first = 0;
  int count = 0;
  int middle = 0;           ///< of these pixels: the first that is not before the cell's center
  std::uint32_t turns = 0;  ///< from the cell's center to the tile's first pixel, 2^−32 of one bin
  /// Distances from the center, squared, in 2.25 squared spacings; 1 in the surplus.
  float squares[wave_tile_side + wave_surplus];
};

/// The rows of a tile that a cell's window reaches, in pairs that are as far from their middle, the nearest first. Pair
/// number `count` may be added too: its rows are no one's.
struct TilePairs {
  static constexpr int most = wave_tile_side / 2;
  int count = 0;
  std::uint32_t turns = 0;                  ///< from the cell's center to the middle, 2^−32 of one bin
  const WaveTable* waves = nullptr;         ///< from the middle to the pairs
  int row[2][most + 1];                     ///< after the middle, before it
  float rest[2][most + wave_surplus] = {};  ///< 1 less the squared distance as of a reach; 0 where there is no such row
};

/// Sums over the cells of a layer on a tile, of all channels and the squared window.
class TileSums {
 public:
  explicit TileSums(int channels);
  void set_zero() { values_.set_zero(); }
  int channels() const { return channels_; }
  /// Row y of a channel; that of the squares is channel number channels(). There is a row wave_tile_side, of no use.
  float* row(int channel, int y) const {
    return values_.data() + y * row_stride() + std::ptrdiff_t{channel} * channel_stride;
  }
  /// From a channel's row to its next.
  std::ptrdiff_t row_stride() const { return std::ptrdiff_t{channels_ + 1} * channel_stride; }
  /// From a row of a channel to that of the next.
  static constexpr int channel_stride = wave_tile_side + wave_surplus;

 private:
  int channels_;
  AlignedBuffer<float> values_;
};

/// The colors of a layer in whole vectors: of number i, real and imaginary parts by turns from i * stride() on.
class LayerColors {
 public:
  LayerColors(const WaveLayer& layer, int channels);
  const float* at(std::uint32_t i) const { return values_.data() + std::size_t{i} * stride_; }
  std::size_t stride() const { return stride_; }

 private:
  std::size_t stride_;
  AlignedBuffer<float> values_;
};

/// Room for the numbers of one cell's waves.
struct CellRoom {
  CellRoom(std::size_t waves, const LayerColors& layer, int channels);
  AlignedBuffer<float> cosines, sines;  ///< of the turns at the tile's first column and the middle of the pairs
  AlignedBuffer<float> colors;          ///< turned as far, laid out as those of the layer
  std::vector<const float*> columns;    ///< in the table of the columns
  std::vector<const float*> rows;       ///< in that of the pairs
  AlignedBuffer<float> products;  ///< colors along a few columns: of each wave and channel real, then imaginary parts
};

/// What a cell's waves are.
struct CellWaves {
  const LayerColors& colors;
  const DrawnWaves& drawn;
  std::size_t cell;  ///< of those drawn
};

/// sums += w n and w² of one cell's waves n on its columns and pairs, `table` being the waves along the tile's columns
/// from its first one. In fused multiply-adds, one wave after the other: the bits do not depend on the processor. One
/// that has no such instruction takes about a hundred times longer.
void add_cell(const std::array<float, lrp_window_terms>& polynomial, const CellWaves& waves, const WaveTable& table,
              const TileReach& columns, const TilePairs& pairs, CellRoom& room, const TileSums& sums);

/// scale[x] = 1 / sqrt(squares[x]), x < count.
void invert_roots(const float* squares, int count, float* scale);

}  // namespace textonbench
