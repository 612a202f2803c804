#include "methods/base/box_fft.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

#include "methods/base/block_fft.h"
#include "methods/base/block_rows.h"
#include "methods/base/fft_lines.h"
#include "methods/base/fft_plan.h"

namespace textonbench {
namespace {

void require_inside(Extent box, Extent raster) {
  if (box.width > raster.width || box.height > raster.height) {
    throw std::invalid_argument(fmt::format("box of {}x{} pixels: expected no more than the raster's {}x{}", box.width,
                                            box.height, raster.width, raster.height));
  }
}

/// A block of this thread's own, kept between calls for the shape that was transformed last.
const BinBlock& scratch_bins(int height, int channels) {
  thread_local std::optional<BinBlock> block;
  thread_local std::pair<int, int> shape;
  if (!block || shape != std::pair(height, channels)) {
    block.emplace(height, channels);
    shape = {height, channels};
  }
  return *block;
}

/// Transforms the first columns of a block back; what the tiles have no room for is dropped.
void transform_columns_back(const BlockFft& fft, const BinBlock& block, int channels, int height, int i,
                            const ColumnTiles& rows) {
  const std::ptrdiff_t size = height * block_row;
  float* pixels = scratch_floats(static_cast<std::size_t>(2 * size));
  for (int c = 0; c < channels; ++c) {
    fft.backward(block.bins(c), pixels, pixels + size);
    std::copy(pixels, pixels + rows.rows() * block_row, rows.tile(i, c));
  }
}

}  // namespace

Spectrum forward_fft_of_box(const Image& box, Extent raster) {
  require_inside(box.extent(), raster);
  Spectrum spectrum = Spectrum::uninitialized(raster, box.channels());
  const LineFft transform_row(raster.width, FftDirection::forward);
  for_row_pairs(box.extent(), box.channels(), [&](int c, int y) {
    const bool partner = y + 1 < box.height();
    std::complex<float>* z = scratch_row(raster.width);
    join_rows(box.row(c, y).data(), partner ? box.row(c, y + 1).data() : nullptr, box.width(), raster.width, z);
    transform_row(z);
    split_spectra(z, raster.width, spectrum.row(c, y).data(), partner ? spectrum.row(c, y + 1).data() : nullptr);
  });
  const LineFft transform_column(raster.height, FftDirection::forward);
  const int blocks = block_count(raster);
  parallel_for(box.channels() * blocks, [&](int i) {
    const ColumnBlock& block = scratch_block(raster, 1);
    const int first = i % blocks * ColumnBlock::width;
    std::complex<float>* bins = spectrum.row(i / blocks, 0).data() + first;
    transpose(bins, spectrum.row_stride(), box.height(), ColumnBlock::width, block.column(0, 0), block.stride());
    for (int k = 0; k < columns_in_block(raster, first); ++k) {
      std::fill(block.column(0, k) + box.height(), block.column(0, k) + raster.height, 0.0F);
      transform_column(block.column(0, k));
    }
    transpose(block.column(0, 0), block.stride(), ColumnBlock::width, raster.height, bins, spectrum.row_stride());
  });
  return spectrum;
}

BinBlock::BinBlock(int height, int channels)
    : stride_(height * block_row), data_(static_cast<std::size_t>(stride_ * channels)) {
  data_.set_zero();
}

void copy_columns(const Spectrum& spectrum, int channel, int first, const BinBlock& block) {
  const int columns = columns_in_block(spectrum.raster(), first);
  for (int y = 0; y < spectrum.rows(); ++y) {
    const std::complex<float>* in = spectrum.row(channel, y).data() + first;
    float* out = block.bins(channel) + y * block_row;
    for (int i = 0; i < BinBlock::width; ++i) {
      out[i] = i < columns ? in[i].real() : 0;
      out[i + BinBlock::width] = i < columns ? in[i].imag() : 0;
    }
  }
}

Image unnormalized_inverse_fft_in_box(const Spectrum& spectrum, Extent box, const BlockMap& map) {
  const Extent raster = spectrum.raster();
  require_inside(box, raster);
  const ColumnTiles rows(raster.width, box.height, spectrum.channels());
  const BlockFft fft(raster.height);
  parallel_for(rows.count(), [&](int i) {
    const BinBlock& block = scratch_bins(raster.height, spectrum.channels());
    for (int c = 0; c < spectrum.channels(); ++c) {
      copy_columns(spectrum, c, i * BinBlock::width, block);
    }
    map(i * BinBlock::width, block);
    transform_columns_back(fft, block, spectrum.channels(), raster.height, i, rows);
  });
  Image image = Image::uninitialized(box, spectrum.channels());
  transform_rows_back(rows, image);
  return image;
}

void map_box_spectrum(Image& box, Extent raster, const BlockMap& map) {
  require_inside(box.extent(), raster);
  const ColumnTiles rows = transform_rows(box, raster.width);
  const BlockFft fft(raster.height);
  const std::ptrdiff_t size = raster.height * block_row;
  const std::ptrdiff_t given = box.height() * block_row;
  parallel_for(rows.count(), [&](int i) {
    const BinBlock& block = scratch_bins(raster.height, box.channels());
    float* pixels = scratch_floats(static_cast<std::size_t>(2 * size));
    for (int c = 0; c < box.channels(); ++c) {
      std::copy(rows.tile(i, c), rows.tile(i, c) + given, pixels);
      std::fill(pixels + given, pixels + size, 0.0F);
      fft.forward(pixels, block.bins(c), pixels + size);
    }
    map(i * BinBlock::width, block);
    transform_columns_back(fft, block, box.channels(), raster.height, i, rows);
  });
  transform_rows_back(rows, box);
}

}  // namespace textonbench
