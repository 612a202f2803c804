// Places of a spline kernel's taps, in the fixed-point coordinates of base/impact_grid.h. What is computed from them
// depends on the distance of a point and an impact alone, wherever in the plane they are.
#pragma once

#include <cstdint>

#include "methods/base/image.h"
#include "methods/base/impact_grid.h"
#include "methods/base/texton.h"

namespace textonbench {

constexpr std::int64_t plane_unit = std::int64_t{1} << plane_bits;

/// A kernel with n rows and columns of zeros on each side has, at distance d of a point from the impact, the n + 1 taps
/// from index floor((d + tap_offset) / plane_unit) on along an axis; the rest is the position between knots.
constexpr std::int64_t tap_offset(int order) {
  return (order - order / 2) * plane_unit + (order % 2 == 0 ? plane_unit / 2 : 0);
}

/// Of a distance in plane units.
inline float knot_position(std::int64_t d) {
  return static_cast<float>(static_cast<std::int32_t>(d & (plane_unit - 1))) * 0x1p-22F;
}

/// First taps 0 … this − 1 along an axis have a tap on the kernel: the pixels that a kernel covers.
inline Extent reach(const SplineTexton& texton) {
  return {texton.coefficients.extent().width + texton.order, texton.coefficients.extent().height + texton.order};
}

/// Where impacts whose kernels reach a point of `points`, all sides of it included, are.
inline PlaneRectangle reaching(int order, Extent reach, const PlaneRectangle& points) {
  const std::int64_t offset = tap_offset(order) + 1;
  return {points.left + offset - reach.width * plane_unit, points.top + offset - reach.height * plane_unit,
          points.right + offset, points.bottom + offset};
}

/// Weights of the order + 1 taps at the position t in [0, 1) between knots, by the recurrence of Cox and de Boor (as
/// in base/bspline.cpp).
template <int order>
[[gnu::always_inline]] inline void spline_weights(float t, float* weights) {
  weights[0] = 1;
#pragma GCC unroll 8
  for (int n = 1; n <= order; ++n) {
    float carried = 0;
#pragma GCC unroll 8
    for (int i = 0; i < n; ++i) {
      const float share = weights[i] * (1.0F / static_cast<float>(n));
      weights[i] = carried + (static_cast<float>(i + 1) - t) * share;
      carried = (t + static_cast<float>(n - i - 1)) * share;
    }
    weights[n] = carried;
  }
}

/// Of the derivative: β^n'(x) = β^(n−1)(x + 1/2) − β^(n−1)(x − 1/2). order >= 1.
template <int order>
[[gnu::always_inline]] inline void spline_slopes(float t, float* weights) {
  spline_weights<order - 1>(t, weights);
  weights[order] = weights[order - 1];
#pragma GCC unroll 8
  for (int i = order - 1; i > 0; --i) {
    weights[i] = weights[i - 1] - weights[i];
  }
  weights[0] = -weights[0];
}

}  // namespace textonbench
