#include "methods/base/box_fft.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

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

/// Half spectra of the rows of `box`, padded to `length` samples.
Spectrum transform_rows(const Image& box, int length) {
  Spectrum rows = Spectrum::uninitialized({length, box.height()}, box.channels());
  const CopyingLineFft transform(length, FftDirection::forward);
  const int stride = (length + 7) / 8 * 8;  // both lines of the scratch row aligned
  for_row_pairs(box.extent(), box.channels(), [&](int c, int y) {
    const bool partner = y + 1 < box.height();
    std::complex<float>* z = scratch_row(2 * stride);
    join_rows(box.row(c, y).data(), partner ? box.row(c, y + 1).data() : nullptr, box.width(), length, z);
    transform(z, z + stride);
    split_spectra(z + stride, length, rows.row(c, y).data(), partner ? rows.row(c, y + 1).data() : nullptr);
  });
  return rows;
}

/// Transforms half spectra of rows back, as far as the columns of the box go.
void transform_rows_back(const Spectrum& rows, Image& box) {
  const int length = rows.raster().width;
  const CopyingLineFft transform(length, FftDirection::backward);
  const int stride = (length + 7) / 8 * 8;  // both lines of the scratch row aligned
  for_row_pairs(box.extent(), box.channels(), [&](int c, int y) {
    const bool partner = y + 1 < box.height();
    std::complex<float>* z = scratch_row(2 * stride);
    join_spectra(rows.row(c, y).data(), partner ? rows.row(c, y + 1).data() : nullptr, length, z);
    transform(z, z + stride);
    split_rows(z + stride, box.width(), box.row(c, y).data(), partner ? box.row(c, y + 1).data() : nullptr);
  });
}

/// Copies the first rows of columns first … between spectrum and block.
void store_columns(const BinBlock& block, int channel, int first, Spectrum& rows) {
  const int columns = columns_in_block(rows.raster(), first);
  for (int y = 0; y < rows.rows(); ++y) {
    const std::complex<float>* in = block.bins(channel) + std::ptrdiff_t{y} * BinBlock::width;
    std::copy(in, in + columns, rows.row(channel, y).data() + first);
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
    : stride_(std::ptrdiff_t{height} * width), data_(static_cast<std::size_t>(stride_ * channels)) {
  data_.set_zero();
}

void copy_columns(const Spectrum& spectrum, int channel, int first, const BinBlock& block) {
  const int columns = columns_in_block(spectrum.raster(), first);
  for (int y = 0; y < spectrum.rows(); ++y) {
    const std::complex<float>* in = spectrum.row(channel, y).data() + first;
    std::complex<float>* out = block.bins(channel) + std::ptrdiff_t{y} * BinBlock::width;
    std::copy(in, in + columns, out);
    std::fill(out + columns, out + BinBlock::width, 0.0F);
  }
}

Image unnormalized_inverse_fft_in_box(const Spectrum& spectrum, Extent box, const BlockMap& map) {
  const Extent raster = spectrum.raster();
  require_inside(box, raster);
  Spectrum rows = Spectrum::uninitialized({raster.width, box.height}, spectrum.channels());
  const BlockFft backward(raster.height, FftDirection::backward);
  parallel_for(block_count(raster), [&](int i) {
    const BinBlock& block = scratch_bins(raster.height, spectrum.channels());
    const int first = i * BinBlock::width;
    for (int c = 0; c < spectrum.channels(); ++c) {
      copy_columns(spectrum, c, first, block);
    }
    map(first, block);
    for (int c = 0; c < spectrum.channels(); ++c) {
      backward(block.bins(c));
      store_columns(block, c, first, rows);
    }
  });
  Image image = Image::uninitialized(box, spectrum.channels());
  transform_rows_back(rows, image);
  return image;
}

void map_box_spectrum(Image& box, Extent raster, const BlockMap& map) {
  require_inside(box.extent(), raster);
  Spectrum rows = transform_rows(box, raster.width);
  const BlockFft forward(raster.height, FftDirection::forward);
  const BlockFft backward(raster.height, FftDirection::backward);
  parallel_for(block_count(raster), [&](int i) {
    const BinBlock& block = scratch_bins(raster.height, box.channels());
    const int first = i * BinBlock::width;
    for (int c = 0; c < box.channels(); ++c) {
      copy_columns(rows, c, first, block);
      std::fill(block.bins(c) + std::ptrdiff_t{box.height()} * BinBlock::width,
                block.bins(c) + std::ptrdiff_t{raster.height} * BinBlock::width, 0.0F);
      forward(block.bins(c));
    }
    map(first, block);
    for (int c = 0; c < box.channels(); ++c) {
      backward(block.bins(c));
      store_columns(block, c, first, rows);
    }
  });
  transform_rows_back(rows, box);
}

}  // namespace textonbench
