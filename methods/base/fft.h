// Two-dimensional real Fourier transforms.
//
// Normalisation, stated once: the forward transform is un-normalised,
//
//   û(kx, ky) = Σ_{x,y} u(x, y) exp(−2πi (kx x / W + ky y / H)),
//
// and the inverse carries the factor 1/(W H), so inverse(forward(u)) = u and Parseval reads
// Σ u² = (1 / (W H)) Σ |û|² over the full spectrum.
#pragma once

#include <complex>
#include <cstdint>
#include <functional>
#include <span>

#include "methods/base/aligned_buffer.h"
#include "methods/base/image.h"

namespace textonbench {

/// Half spectrum of a real raster of size `raster`, one plane a channel: rows ky = 0 … H−1 of W/2 + 1 bins
/// kx = 0 … W/2. The other half follows from û(−k) = conj û(k). Rows start on 64-byte
/// boundaries: walk a plane row by row.
class Spectrum {
 public:
  Spectrum() = default;
  /// A zero spectrum. Throws std::invalid_argument as Image does.
  Spectrum(Extent raster, int channels);
  /// The same without zeroing: for a caller that writes every bin.
  static Spectrum uninitialized(Extent raster, int channels);

  Extent raster() const { return raster_; }
  int channels() const { return channels_; }
  /// Number of stored bins in a row, W/2 + 1.
  int columns() const { return raster_.width / 2 + 1; }
  int rows() const { return raster_.height; }
  /// Stored bins of one channel.
  std::int64_t bins() const { return std::int64_t{columns()} * rows(); }

  std::span<std::complex<float>> row(int channel, int ky) {
    return {data_.data() + offset(channel, ky), static_cast<std::size_t>(columns())};
  }
  std::span<const std::complex<float>> row(int channel, int ky) const {
    return {data_.data() + offset(channel, ky), static_cast<std::size_t>(columns())};
  }
  std::complex<float>& at(int channel, int kx, int ky) { return row(channel, ky)[static_cast<std::size_t>(kx)]; }
  std::complex<float> at(int channel, int kx, int ky) const { return row(channel, ky)[static_cast<std::size_t>(kx)]; }

  /// How many bins of the full spectrum the stored bin stands for: 1 in column 0 and, for even widths, in the last
  /// column (their mirror images are stored too); 2 elsewhere.
  int multiplicity(int kx) const { return kx == 0 || 2 * kx == raster_.width ? 1 : 2; }
  /// True where k = −k on the torus (DC and the Nyquist bins of even sides): there û is real.
  bool self_conjugate(int kx, int ky) const {
    return (kx == 0 || 2 * kx == raster_.width) && (ky == 0 || 2 * ky == raster_.height);
  }
  /// Distance in bins between the starts of consecutive rows: columns() rounded up to whole column blocks.
  std::int64_t row_stride() const { return (std::int64_t{columns()} + 7) / 8 * 8; }
  std::size_t bytes() const { return data_.bytes(); }

 private:
  std::size_t offset(int channel, int ky) const {
    return static_cast<std::size_t>((std::int64_t{channel} * raster_.height + ky) * row_stride());
  }

  Extent raster_;
  int channels_ = 0;
  AlignedBuffer<std::complex<float>> data_;
};

/// Forward transform of every channel. Rows and columns are transformed in parallel; the bits do not depend on how many
/// threads do it. Error below 2e-7 sqrt(max(1, log2(W H))) of the largest coefficient of the channel.
Spectrum forward_fft(const Image& image);

/// Inverse transform of every channel; the imaginary part of self-conjugate bins is ignored.
Image inverse_fft(const Spectrum& spectrum);

/// Some columns of a spectrum that is made while it is transformed: bins (first + i, ky), ky = 0 … H − 1, of channel c
/// follow each other from column(c, i) on.
class ColumnBlock {
 public:
  /// As many bins as fill a cache line of a row.
  static constexpr int width = 8;

  ColumnBlock(Extent raster, int channels);
  /// Distance in bins between the starts of consecutive columns.
  std::ptrdiff_t stride() const { return stride_; }
  std::complex<float>* column(int channel, int i) const { return data_.data() + (channel * width + i) * stride_; }

 private:
  std::ptrdiff_t stride_;
  AlignedBuffer<std::complex<float>> data_;
};

/// Copies columns first … first + 7 of a channel into the block.
void copy_columns(const Spectrum& spectrum, int channel, int first, const ColumnBlock& block);

/// Writes the columns first … first + 7 into the block, `first` being a multiple of 8; what it writes for columns
/// beyond W/2 is ignored.
using ColumnSource = std::function<void(int first, const ColumnBlock& block)>;

/// W H times the inverse transform of the spectrum that `source` makes, which never exists as a whole. Called from
/// several threads at once.
Image unnormalized_inverse_fft(Extent raster, int channels, const ColumnSource& source);

/// Smallest n >= minimum of the form 2^a 3^b 5^c 7^d, a size that FFTW handles well. Throws std::invalid_argument
/// unless minimum is in [1, 2^30].
int good_fft_size(int minimum);

}  // namespace textonbench
