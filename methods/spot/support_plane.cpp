#include "methods/spot/support_plane.h"

#include <fmt/format.h>

#include <stdexcept>

namespace textonbench {

SupportPlane::SupportPlane(const Image& mask, int channels, Extent torus) : box_(mask.extent()), channels_(channels) {
  if (mask.channels() != 1) {
    throw std::invalid_argument(fmt::format("support mask of {} channels: expected 1", mask.channels()));
  }
  if (box_.width > torus.width || box_.height > torus.height) {
    throw std::invalid_argument(fmt::format("support of {}x{} pixels: expected at most the exemplar's {}x{}",
                                            box_.width, box_.height, torus.width, torus.height));
  }
  for (int y = 0; y < box_.height; ++y) {
    for (int x = 0; x < box_.width; ++x) {
      if (mask.at(0, x, y) != 0) {
        pixels_.push_back({x, y});
      }
    }
  }
  if (pixels_.empty()) {
    throw std::invalid_argument(
        fmt::format("support mask of {}x{} pixels is empty: expected at least one pixel that is not zero", box_.width,
                    box_.height));
  }
}

void SupportPlane::scatter(std::span<const double> values, Image& image) const {
  std::size_t i = 0;
  for (int c = 0; c < channels_; ++c) {
    for (const auto [x, y] : pixels_) {
      image.at(c, x, y) = static_cast<float>(values[i++]);
    }
  }
}

void SupportPlane::gather(const Image& image, double factor, std::span<double> values) const {
  std::size_t i = 0;
  for (int c = 0; c < channels_; ++c) {
    for (const auto [x, y] : pixels_) {
      values[i++] = factor * static_cast<double>(image.at(c, x, y));
    }
  }
}

}  // namespace textonbench
