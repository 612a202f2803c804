// Where on the plane a mixture of two textures is which.
#pragma once

#include <cstdint>
#include <vector>

#include "methods/base/image.h"

namespace textonbench {

/// The share ρ in [0, 1] of the second of two textures at every point of the plane, and the kernel, of R kernels for
/// the shares r / (R − 1), of the share nearest to it: round(ρ (R − 1)), halves up.
class PlaneShare {
 public:
  enum class Kind { uniform, ramp, map };

  /// The same everywhere. Throws std::invalid_argument for a share outside [0, 1].
  static PlaneShare uniform(double share);
  /// 0 up to the column `start`, from there linear over `length` pixels, then 1. Throws std::invalid_argument for a
  /// start that is not finite and a length that is not positive and finite.
  static PlaneShare ramp(double start, double length);
  /// The first channel of a picture, pixel by pixel, which goes on beyond its borders. Throws std::invalid_argument
  /// for a value outside [0, 1], with its place.
  static PlaneShare map(Image picture);

  Kind kind() const { return kind_; }
  double at(double x, double y) const;
  int kernel_at(double x, double y, int kernels) const;
  double start() const { return start_; }
  double length() const { return length_; }
  const Image& picture() const { return map_; }

 private:
  PlaneShare(Kind kind, double start, double length, Image picture);

  Kind kind_;
  double start_;  // of a ramp; the share itself where it is uniform
  double length_;
  Image map_;
};

/// Number of the kernel that is centered at a point: `corner` in 2^−22 pixel is its pixel (0, 0), `box` its size.
int kernel_with_corner(const PlaneShare& share, std::int64_t corner_x, std::int64_t corner_y, Extent box, int kernels);

/// Where kernels of that width change along a ramp: kernel_with_corner() is how many of these R − 1 ascending corners,
/// in 2^−22 pixel, are at most corner_x. Where the change would be beyond ±2^62 it is there.
std::vector<std::int64_t> ramp_borders(const PlaneShare& share, Extent box, int kernels);

/// The bits of the least floats in [0, 1] whose kernel is number 1, 2, … R − 1; 0x7F800000 where there is none. Floats
/// from 0 on have the order of their bits.
std::vector<std::uint32_t> share_borders(int kernels);

}  // namespace textonbench
