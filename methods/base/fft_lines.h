// Rows and columns of two-dimensional transforms, for fft.cpp and box_fft.cpp.
#pragma once

#include <algorithm>
#include <complex>
#include <cstddef>

#include "methods/base/fft.h"
#include "methods/base/parallel.h"

namespace textonbench {

/// out[i * out_stride + j] = in[j * in_stride + i], j < rows, i < columns.
void transpose(const std::complex<float>* in, std::ptrdiff_t in_stride, int rows, int columns, std::complex<float>* out,
               std::ptrdiff_t out_stride);

// Two real rows a and b make one complex row z = a + i b, whose transform is taken apart by symmetry:
// â(k) = (ẑ(k) + conj ẑ(−k)) / 2, b̂(k) = (ẑ(k) − conj ẑ(−k)) / 2i. FFTW transforms one complex row much faster than
// two real ones. `b` is null for a last row without a partner.

/// z = a + i b; the rows hold `given` samples and are padded by zeros to `length`.
void join_rows(const float* a, const float* b, int given, int length, std::complex<float>* z);
void split_rows(const std::complex<float>* z, int length, float* a, float* b);
void join_spectra(const std::complex<float>* a, const std::complex<float>* b, int length, std::complex<float>* z);
void split_spectra(const std::complex<float>* z, int length, std::complex<float>* a, std::complex<float>* b);

/// Number of column blocks of a half spectrum, and of the columns in the block that starts at `first`.
inline int block_count(Extent raster) { return raster.width / 2 / ColumnBlock::width + 1; }
inline int columns_in_block(Extent raster, int first) {
  return std::min(ColumnBlock::width, raster.width / 2 + 1 - first);
}

/// A block, and a row of at least that length, of this thread's own; the block is kept between calls for the shape that
/// was transformed last.
const ColumnBlock& scratch_block(Extent raster, int channels);
std::complex<float>* scratch_row(int length);

/// Calls body(channel, y) for y = 0, 2, 4, … of every channel.
template <class Body>
void for_row_pairs(Extent raster, int channels, const Body& body) {
  const int pairs = (raster.height + 1) / 2;
  parallel_for(channels * pairs, [&](int i) { body(i / pairs, 2 * (i % pairs)); });
}

}  // namespace textonbench
