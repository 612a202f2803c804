#include "methods/base/image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace textonbench {
namespace {

constexpr int floats_per_line = 16;

}  // namespace

Image Image::uninitialized(Extent extent, int channels) {
  if (extent.width < 1 || extent.height < 1) {
    throw std::invalid_argument(
        fmt::format("image size {}x{}: both sides must be at least 1", extent.width, extent.height));
  }
  if (extent.area() > max_pixels) {
    throw std::invalid_argument(
        fmt::format("image size {}x{}: at most 2^40 pixels are possible", extent.width, extent.height));
  }
  if (channels < 1 || channels > max_channels) {
    throw std::invalid_argument(fmt::format("image with {} channels: expected 1 to {}", channels, max_channels));
  }
  Image image;
  image.extent_ = extent;
  image.channels_ = channels;
  image.row_stride_ =
      (static_cast<std::ptrdiff_t>(extent.width) + 2 + floats_per_line - 1) / floats_per_line * floats_per_line;
  image.data_ = AlignedBuffer<float>(static_cast<std::size_t>(image.row_stride_) *
                                     static_cast<std::size_t>(extent.height) * static_cast<std::size_t>(channels));
  return image;
}

Image::Image(Extent extent, int channels) : Image(uninitialized(extent, channels)) { data_.set_zero(); }

Image crop(const Image& source, int x, int y, Extent extent) {
  if (x < 0 || y < 0 || extent.width > source.width() - x || extent.height > source.height() - y) {
    throw std::invalid_argument(fmt::format("window {}x{} at ({}, {}) is not inside an image of {}x{}", extent.width,
                                            extent.height, x, y, source.width(), source.height()));
  }
  Image window(extent, source.channels());
  for (int c = 0; c < source.channels(); ++c) {
    for (int row = 0; row < extent.height; ++row) {
      const auto from = source.row(c, y + row).subspan(static_cast<std::size_t>(x), window.row(c, row).size());
      std::ranges::copy(from, window.row(c, row).begin());
    }
  }
  return window;
}

std::optional<PixelPosition> find_non_finite(const Image& image) {
  for (int c = 0; c < image.channels(); ++c) {
    for (int y = 0; y < image.height(); ++y) {
      const auto row = image.row(c, y);
      const auto bad = std::ranges::find_if(row, [](float v) { return !std::isfinite(v); });
      if (bad != row.end()) {
        return PixelPosition{c, static_cast<int>(bad - row.begin()), y};
      }
    }
  }
  return std::nullopt;
}

}  // namespace textonbench
