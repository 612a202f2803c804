// A set of pixels.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "methods/base/image.h"

namespace textonbench {

/// One bit a pixel of a raster: row y is at bits[y * width].
class Mask {
 public:
  Mask() = default;
  /// Throws std::invalid_argument unless both sides are at least 1.
  explicit Mask(Extent extent, bool value = false);

  Extent extent() const { return extent_; }
  bool at(int x, int y) const { return bits_[index(x, y)] != 0; }
  void set(int x, int y, bool value) { bits_[index(x, y)] = value ? 1 : 0; }
  /// How many pixels are in the set.
  std::int64_t count() const;
  friend bool operator==(const Mask&, const Mask&) = default;

 private:
  std::size_t index(int x, int y) const { return static_cast<std::size_t>(std::int64_t{y} * extent_.width + x); }

  Extent extent_;
  std::vector<std::uint8_t> bits_;
};

/// Every pixel within `distance` (the larger of the distances across and down) of one in the set, around the edges of
/// the raster when it is a torus. Time does not depend on the distance. Throws std::invalid_argument for a distance
/// below 0.
Mask dilate(const Mask& mask, int distance, bool torus = false);

/// Pixels that are in a and not in b. Throws std::invalid_argument when sizes differ.
Mask difference(const Mask& a, const Mask& b);

struct Pixel {
  int x = 0;
  int y = 0;
  friend bool operator==(const Pixel&, const Pixel&) = default;
};

/// The pixels of the set, row by row.
std::vector<Pixel> pixels_of(const Mask& mask);

/// A rectangle of pixels.
struct Rectangle {
  int x = 0;
  int y = 0;
  Extent size;
  friend bool operator==(const Rectangle&, const Rectangle&) = default;
};

/// The smallest rectangle that holds all pixels. Throws std::invalid_argument when there are none.
Rectangle bounding_box(std::span<const Pixel> pixels);

/// What is known of a picture: a linear operator with its data. Pixels in `missing` are unknown, the others are those
/// of the exemplar.
struct Observation {
  Mask missing;
};

}  // namespace textonbench
