// Real transforms of sixteen rows of an image at a time, for box_fft.cpp.
//
// Two rows make one complex line, whose transform is taken apart by symmetry (fft_lines.h); eight such lines make one
// block (block_fft.h).
#pragma once

#include "methods/base/block_fft.h"
#include "methods/base/image.h"

namespace textonbench {

/// Half spectra of rows, in tiles of eight neighboring columns: of bin (8 i + j, y) of channel c the real part is at
/// tile(i, c)[16 y + j], the imaginary part 8 later. A tile is the first numbers of a block. Not initialised.
class ColumnTiles {
 public:
  /// Half spectra of `rows` rows of `length` samples.
  ColumnTiles(int length, int rows, int channels);

  int length() const { return length_; }
  int rows() const { return rows_; }
  int count() const { return length_ / 2 / block_lines + 1; }
  float* tile(int i, int channel) const { return data_.data() + (std::ptrdiff_t{i} * channels_ + channel) * stride_; }

 private:
  int length_, rows_, channels_;
  std::ptrdiff_t stride_;
  AlignedBuffer<float> data_;
};

/// Half spectra of the rows of `image`, padded by zeros to `length` samples. Columns beyond length / 2 are zero.
ColumnTiles transform_rows(const Image& image, int length);

/// The first samples of the un-normalised inverse transforms of the rows, as many as the rows of `image` hold.
void transform_rows_back(const ColumnTiles& spectra, Image& image);

/// Room for `size` floats of this thread's own, aligned, whose contents the next call may change.
float* scratch_floats(std::size_t size);

}  // namespace textonbench
