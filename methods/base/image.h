// The one raster type of the project.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "methods/base/aligned_buffer.h"

namespace textonbench {

/// Width and height of a raster in pixels.
struct Extent {
  int width = 0;
  int height = 0;

  std::int64_t area() const { return std::int64_t{width} * height; }
  friend bool operator==(const Extent&, const Extent&) = default;
};

/// Planar float32 raster of 1 to 8 channels. Every row starts on a 64-byte boundary and is followed by padding, at
/// least two floats, so that it can hold its own half spectrum: walk a plane row by row. Values are linear samples as
/// stored in the file, nominally in [0,1]; models and samples may leave that interval and are never clamped before they
/// are written.
///
/// A new image is zero. Copies are deep.
class Image {
 public:
  static constexpr int max_channels = 8;
  static constexpr std::int64_t max_pixels = std::int64_t{1} << 40;

  Image() = default;
  /// Throws std::invalid_argument unless both sides are at least 1, their product at most max_pixels and channels in
  /// [1, max_channels]; std::bad_alloc when memory is short.
  Image(Extent extent, int channels);

  /// The same without zeroing: for a caller that writes every sample.
  static Image uninitialized(Extent extent, int channels);

  Extent extent() const { return extent_; }
  int width() const { return extent_.width; }
  int height() const { return extent_.height; }
  int channels() const { return channels_; }
  bool empty() const { return data_.size() == 0; }

  /// Distance in floats between the starts of consecutive rows (a multiple of 16).
  std::ptrdiff_t row_stride() const { return row_stride_; }
  /// Bytes held, padding included.
  std::size_t bytes() const { return data_.bytes(); }

  std::span<float> row(int channel, int y) { return {pointer(channel, y), static_cast<std::size_t>(extent_.width)}; }
  std::span<const float> row(int channel, int y) const {
    return {pointer(channel, y), static_cast<std::size_t>(extent_.width)};
  }
  float& at(int channel, int x, int y) { return pointer(channel, y)[x]; }
  float at(int channel, int x, int y) const { return pointer(channel, y)[x]; }
  /// First sample of a channel, for libraries that take a pointer and a stride.
  float* plane(int channel) { return pointer(channel, 0); }
  const float* plane(int channel) const { return pointer(channel, 0); }

 private:
  float* pointer(int channel, int y) const {
    return data_.data() + (static_cast<std::ptrdiff_t>(channel) * extent_.height + y) * row_stride_;
  }

  Extent extent_;
  int channels_ = 0;
  std::ptrdiff_t row_stride_ = 0;
  AlignedBuffer<float> data_;
};

/// Window of `source` starting at (x, y). Throws std::invalid_argument when it is not inside.
Image crop(const Image& source, int x, int y, Extent extent);

struct PixelPosition {
  int channel, x, y;
};

/// Place of the first sample that is NaN or infinite, if there is one.
std::optional<PixelPosition> find_non_finite(const Image& image);

}  // namespace textonbench
