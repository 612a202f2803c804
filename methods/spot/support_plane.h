// Numbers on the pixels of a support, and the images they make: the variables of the optimizations over textons.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "methods/base/image.h"

namespace textonbench {

/// The pixels of a mask, row by row, and C channels over them. A function on the support is a vector of size() numbers,
/// channel by channel.
class SupportPlane {
 public:
  /// Pixels of `mask` (one channel) that are not zero belong to the support. Throws std::invalid_argument when none
  /// does, when the mask has several channels, or is larger than `torus` on either side.
  SupportPlane(const Image& mask, int channels, Extent torus);

  Extent box() const { return box_; }
  int channels() const { return channels_; }
  std::int64_t pixels() const { return static_cast<std::int64_t>(pixels_.size()); }
  std::size_t size() const { return pixels_.size() * static_cast<std::size_t>(channels_); }

  /// Writes the function into the corner of an image that is zero off the support and at least as large as the box.
  void scatter(std::span<const double> values, Image& image) const;
  /// The pixels of the support of such an image, times a factor.
  void gather(const Image& image, double factor, std::span<double> values) const;

 private:
  struct Pixel {
    int x, y;
  };
  Extent box_;
  int channels_;
  std::vector<Pixel> pixels_;
};

}  // namespace textonbench
