// The inner loops of add_gabor: a band's impacts on the pixels of a tile.
#pragma once

#include <cstdint>
#include <span>

#include "methods/base/aligned_buffer.h"
#include "methods/sparse/gabor_kernel.h"

namespace textonbench {

/// Columns and rows of a tile, whole vectors.
constexpr int gabor_tile_width = 128;
constexpr int gabor_tile_height = 128;

/// Pixels along an axis of a tile, in pixels from some origin. Places behind the last pixel go on as before it.
struct GaborTileAxis {
  GaborTileAxis(double start, double step, int first, int count, int room);

  int count;
  double step;              ///< pixels from one to the next
  double start;             ///< the first, about, from the origin
  std::int64_t first, end;  ///< coordinates of the first and last pixel, 2^−22 pixel
  std::int64_t origin;      ///< pixels
  AlignedBuffer<std::int32_t> whole;
  AlignedBuffer<float> part;
};

/// Sums on a tile, of all channels.
class GaborTileSums {
 public:
  explicit GaborTileSums(int channels);
  int channels() const { return channels_; }
  float* row(int channel, int y) const { return values_.data() + y * row_stride() + channel * channel_stride; }
  /// From a channel's row to its next, and to that row of the next channel.
  std::ptrdiff_t row_stride() const { return std::ptrdiff_t{channels_} * channel_stride; }
  static constexpr std::ptrdiff_t channel_stride = gabor_tile_width + 16;

 private:
  int channels_;
  AlignedBuffer<float> values_;
};

/// Room for the columns and rows of a kernel.
struct GaborTileRoom {
  explicit GaborTileRoom(int channels);

  /// Of a vector of columns: squares U² or, of skewed kernels, U, of each of 16; then real and imaginary parts.
  float* column(int vector) const { return columns.data() + std::ptrdiff_t{vector} * column_stride; }
  static constexpr std::ptrdiff_t column_stride = 48;
  /// From a number of the rows to their next: what is left of the limit, what their y adds to U, and of each channel
  /// real and imaginary parts.
  static constexpr std::ptrdiff_t row_stride = gabor_tile_height;

  /// The rows that each vector of the tile's columns may have pixels in.
  alignas(64) std::int32_t top[16];
  alignas(64) std::int32_t bottom[16];
  AlignedBuffer<float> columns, rows;
  int first_vector = 0, end_vector = 0;
};

/// sums += the kernels, in their order, at the pixels (x, y).
void add_to_tile(const GaborShape& shape, std::span<const NearImpact> impacts, const GaborTileAxis& x,
                 const GaborTileAxis& y, GaborTileRoom& room, const GaborTileSums& sums);

}  // namespace textonbench
