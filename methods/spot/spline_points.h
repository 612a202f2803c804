// A sum of spline kernels at any points of the plane.
#pragma once

#include <cstdint>
#include <span>

#include "methods/base/aligned_buffer.h"
#include "methods/base/image.h"
#include "methods/base/impact_grid.h"
#include "methods/base/texton.h"

namespace textonbench {

/// In 2^−22 pixel.
struct PlanePoint {
  std::int64_t x = 0;
  std::int64_t y = 0;
};

/// What is summed: h or a partial derivative of it.
enum class Derivative { none, x, y };

/// Evaluates scale Σ_i w_i h_{k_i}(y − x_i) impact by impact, all channels at once. The bits of a point's value depend
/// on the point alone.
class SplinePoints {
 public:
  SplinePoints(const SplineTexton& texton, double scale);

  /// out[i * lanes() + c] = channel c at points[i], which lie within 64 pixels of each other: the impacts in reach of
  /// any of them are drawn once. `out` grows as needed.
  void sum(const ImpactGrid& grid, std::uint64_t key, std::span<const PlanePoint> points, Derivative derivative,
           AlignedBuffer<float>& out) const;

  /// Channels rounded up to 4 or 8.
  int lanes() const { return lanes_; }
  std::size_t bytes() const { return coefficients_.bytes(); }

 private:
  int order_;
  Extent reach_;
  int lanes_;
  std::int64_t row_stride_;     // floats
  std::int64_t kernel_stride_;  // floats
  AlignedBuffer<float> coefficients_;
};

}  // namespace textonbench
