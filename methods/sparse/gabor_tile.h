// The inner loops of add_gabor: a band's impacts on the pixels of a tile.
#pragma once

#include <cstdint>
#include <span>

#include "methods/base/aligned_buffer.h"
#include "methods/sparse/gabor_kernel.h"

namespace textonbench {

/// Columns and rows of a tile, whole vectors.
constexpr int gabor_tile_width = 128;
constexpr int gabor_tile_height = 64;

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

/// Room for the columns and rows of some kernels.
struct GaborTileRoom {
  /// Kernels that are made at a time.
  static constexpr int kernels = 64;
  static constexpr int vectors = gabor_tile_width / 16;

  explicit GaborTileRoom(int channels);

  /// Of a vector of columns: 16 forms or places each, then real parts, then imaginary ones.
  static constexpr int column_stride = 48;
  /// Of rows: what is left of the limit, places, and of each channel real and imaginary parts, each as long.
  static constexpr int row_stride = gabor_tile_height;
  /// A kernel on the tile.
  struct Kernel {
    int first_vector = 0, end_vector = 0, first_row = 0;
    /// The rows that each vector of the tile's columns may have pixels in.
    alignas(64) std::int32_t top[16];
    alignas(64) std::int32_t bottom[16];
  };

  float* column(int number, int vector) const {
    return columns.data() + (std::ptrdiff_t{number} * vectors + vector) * column_stride;
  }
  float* row(int number) const { return rows.data() + std::ptrdiff_t{number} * rows_size; }

  std::ptrdiff_t rows_size;
  AlignedBuffer<float> columns, rows;
  AlignedBuffer<Kernel> kernel;
};

/// sums += the kernels, in their order, at the pixels (x, y).
void add_to_tile(const GaborShape& shape, std::span<const NearImpact> impacts, const GaborTileAxis& x,
                 const GaborTileAxis& y, GaborTileRoom& room, const GaborTileSums& sums);

}  // namespace textonbench
