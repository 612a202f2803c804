// Fourier transforms of images that are zero outside a box, or that are wanted in a box only, in the scaling of fft.h.
//
// The box is the corner [0, w) x [0, h) of the raster. Rows outside it are never transformed: of the lines of a
// transform of W x H about h + W/2 are left, each pair of rows counting one, of H/2 + W/2.
#pragma once

#include <functional>

#include "methods/base/fft.h"

namespace textonbench {

/// Spectrum on `raster` of the image that is `box` in its corner and zero elsewhere. Throws std::invalid_argument when
/// the box is larger than the raster.
Spectrum forward_fft_of_box(const Image& box, Extent raster);

/// Eight neighboring columns of a spectrum, all channels: of bin (first + i, ky) of channel c the real part is at
/// bins(c)[16 * ky + i], the imaginary part 8 later.
class BinBlock {
 public:
  static constexpr int width = 8;

  BinBlock(int height, int channels);
  float* bins(int channel) const { return data_.data() + channel * stride_; }

 private:
  std::ptrdiff_t stride_;
  AlignedBuffer<float> data_;
};

/// Copies columns first … first + 7 of a channel, `first` being a multiple of 8; zero beyond W/2.
void copy_columns(const Spectrum& spectrum, int channel, int first, const BinBlock& block);

/// Changes the columns first … first + 7 of a spectrum in place. Those beyond W/2 hold nothing.
using BlockMap = std::function<void(int first, const BinBlock& block)>;

/// The corner of size `box` of W H times the inverse transform of map(spectrum). `map` is called once for every block
/// of columns, from several threads at once. Throws std::invalid_argument when the box is larger than the raster.
Image unnormalized_inverse_fft_in_box(const Spectrum& spectrum, Extent box, const BlockMap& map);

/// Replaces `box` by the corner of W H times the inverse transform of map(forward_fft_of_box(box, raster)). Every block
/// of columns is transformed, mapped and transformed back while it is in cache: the spectrum never exists as a whole.
/// Calls and errors are those of unnormalized_inverse_fft_in_box.
void map_box_spectrum(Image& box, Extent raster, const BlockMap& map);

}  // namespace textonbench
