#include "methods/spot/spline_points.h"

#include <algorithm>

#include "methods/base/bspline.h"
#include "methods/spot/spline_place.h"

namespace textonbench {
namespace {

/// Channels of a tap.
template <int lanes>
struct TapVector;
template <>
struct TapVector<4> {
  using Type = float __attribute__((vector_size(16), may_alias));
};
template <>
struct TapVector<8> {
  using Type = float __attribute__((vector_size(32), may_alias));
};

/// Coefficients, channels together.
struct TapTable {
  const float* data;
  std::int32_t row_stride;
  Extent reach;
};

constexpr int most_points = 256;

/// Points in 2^−22 pixel from the first of them, which fits 32 bits.
struct NearPoints {
  int count = 0;
  alignas(64) std::int32_t x[most_points];
  alignas(64) std::int32_t y[most_points];
};

/// Taps of one impact at each point.
struct PointTaps {
  alignas(64) std::int32_t first[most_points];  ///< place of the first one in the table; below 0 out of reach
  alignas(64) float wx[max_bspline_order + 1][most_points];
  alignas(64) float wy[max_bspline_order + 1][most_points];
};

template <int order, bool slope>
[[gnu::always_inline]] inline void place_weights(std::int32_t d, float (*weights)[most_points], int i) {
  float w[order + 1];
  if constexpr (slope && order > 0) {
    spline_slopes<order>(knot_position(d), w);
  } else {
    spline_weights<order>(knot_position(d), w);
  }
#pragma GCC unroll 8
  for (int j = 0; j <= order; ++j) {
    weights[j][i] = w[j];
  }
}

/// Taps at the points whose distance from the impact is (x, y) plane units more than theirs from the first point. The
/// whole pixels of (x, y) are kept apart, so that 32 bits do for kernels of any size.
template <int order, int lanes, Derivative derivative>
[[gnu::always_inline]] inline void place_taps(const TapTable& table, const NearPoints& points, std::int64_t x,
                                              std::int64_t y, PointTaps& taps) {
  const auto column_of_first = static_cast<std::int32_t>(x >> plane_bits);
  const auto row_of_first = static_cast<std::int32_t>(y >> plane_bits);
  const auto rest_x = static_cast<std::int32_t>(x & (plane_unit - 1));
  const auto rest_y = static_cast<std::int32_t>(y & (plane_unit - 1));
  for (int i = 0; i < points.count; ++i) {
    const std::int32_t dx = points.x[i] + rest_x;
    const std::int32_t dy = points.y[i] + rest_y;
    const std::int32_t column = column_of_first + (dx >> plane_bits);
    const std::int32_t row = row_of_first + (dy >> plane_bits);
    const bool outside = (column < 0) | (column >= table.reach.width) | (row < 0) | (row >= table.reach.height);
    const std::int32_t place = row * table.row_stride + column * lanes;
    taps.first[i] = outside ? -1 : place;
    place_weights<order, derivative == Derivative::x>(dx, taps.wx, i);
    place_weights<order, derivative == Derivative::y>(dy, taps.wy, i);
  }
}

/// sums[i] += weight Σ_j wy_j Σ_k wx_k (tap k of row j) at each point i in reach.
template <int order, int lanes>
[[gnu::always_inline]] inline void add_taps(const float* data, std::ptrdiff_t row_stride, const PointTaps& taps,
                                            int count, float weight, float* sums) {
  using Tap = typename TapVector<lanes>::Type;
  for (int i = 0; i < count; ++i, sums += lanes) {
    if (taps.first[i] < 0) {
      continue;
    }
    const float* from = data + taps.first[i];
    Tap value{};
#pragma GCC unroll 8
    for (int j = 0; j <= order; ++j) {
      const Tap* row = reinterpret_cast<const Tap*>(from + j * row_stride);
      Tap blend = taps.wx[0][i] * row[0];
#pragma GCC unroll 8
      for (int k = 1; k <= order; ++k) {
        blend += taps.wx[k][i] * row[k];
      }
      value = j == 0 ? taps.wy[0][i] * blend : value + taps.wy[j][i] * blend;
    }
    *reinterpret_cast<Tap*>(sums) += weight * value;
  }
}

/// Everything that the sums at some points need.
struct PointSum {
  TapTable table;
  std::int64_t kernel_stride;
  std::span<const PlaneImpact> impacts;
  PlanePoint first;
  const NearPoints& points;
  Derivative derivative;
  float* sums;
};

template <int order, int lanes, Derivative derivative>
[[gnu::always_inline]] inline void add_impacts(const PointSum& sum) {
  PointTaps taps;
  for (const PlaneImpact& impact : sum.impacts) {
    place_taps<order, lanes, derivative>(sum.table, sum.points, sum.first.x + tap_offset(order) - impact.x,
                                         sum.first.y + tap_offset(order) - impact.y, taps);
    add_taps<order, lanes>(sum.table.data + impact.kernel * sum.kernel_stride, sum.table.row_stride, taps,
                           sum.points.count, impact.weight, sum.sums);
  }
}

template <int order, int lanes>
[[gnu::always_inline]] inline void add_impacts_of_order(const PointSum& sum) {
  switch (sum.derivative) {
    case Derivative::none:
      return add_impacts<order, lanes, Derivative::none>(sum);
    case Derivative::x:
      return add_impacts<order, lanes, Derivative::x>(sum);
    case Derivative::y:
      return add_impacts<order, lanes, Derivative::y>(sum);
  }
}

template <int lanes>
[[gnu::always_inline]] inline void add_impacts_of_lanes(int order, const PointSum& sum) {
  switch (order) {
    case 0:
      return add_impacts_of_order<0, lanes>(sum);
    case 1:
      return add_impacts_of_order<1, lanes>(sum);
    case 2:
      return add_impacts_of_order<2, lanes>(sum);
    case 3:
      return add_impacts_of_order<3, lanes>(sum);
    case 4:
      return add_impacts_of_order<4, lanes>(sum);
    default:
      return add_impacts_of_order<5, lanes>(sum);
  }
}

__attribute__((target_clones("default", "avx2", "avx512f"))) void add_impacts_of_four(int order, const PointSum& sum) {
  add_impacts_of_lanes<4>(order, sum);
}

__attribute__((target_clones("default", "avx2", "avx512f"))) void add_impacts_of_eight(int order, const PointSum& sum) {
  add_impacts_of_lanes<8>(order, sum);
}

}  // namespace

SplinePoints::SplinePoints(const SplineTexton& texton, double scale)
    : order_(texton.order), reach_(reach(texton)), lanes_(texton.coefficients.channels() <= 4 ? 4 : 8) {
  const int frame = texton.order;
  const auto [width, height] = texton.coefficients.extent();
  row_stride_ = std::int64_t{width + 2 * frame} * lanes_;
  kernel_stride_ = row_stride_ * (height + 2 * frame);
  coefficients_ = AlignedBuffer<float>(static_cast<std::size_t>(kernel_stride_) * texton.coefficients.kernels.size());
  coefficients_.set_zero();
  float* kernel_start = coefficients_.data();
  for (const Image& kernel : texton.coefficients.kernels) {
    for (int c = 0; c < kernel.channels(); ++c) {
      for (int y = 0; y < height; ++y) {
        float* to = kernel_start + (y + frame) * row_stride_ + std::int64_t{frame} * lanes_ + c;
        for (const float v : kernel.row(c, y)) {
          *to = static_cast<float>(scale * v);
          to += lanes_;
        }
      }
    }
    kernel_start += kernel_stride_;
  }
}

void SplinePoints::sum(const ImpactGrid& grid, std::uint64_t key, std::span<const PlanePoint> points,
                       Derivative derivative, AlignedBuffer<float>& out) const {
  const auto [left, right] = std::ranges::minmax(points, {}, &PlanePoint::x);
  const auto [top, bottom] = std::ranges::minmax(points, {}, &PlanePoint::y);
  std::vector<PlaneImpact> impacts;
  grid.draw(key, reaching(order_, reach_, {left.x, top.y, right.x, bottom.y}), impacts);
  const std::size_t size = points.size() * static_cast<std::size_t>(lanes_);
  if (out.size() < size) {
    out = AlignedBuffer<float>(size);
  }
  std::fill_n(out.data(), size, 0.0F);
  NearPoints near;
  for (std::size_t done = 0; done < points.size(); done += static_cast<std::size_t>(near.count)) {
    near.count = static_cast<int>(std::min<std::size_t>(most_points, points.size() - done));
    for (int i = 0; i < near.count; ++i) {
      const PlanePoint& point = points[done + static_cast<std::size_t>(i)];
      near.x[i] = static_cast<std::int32_t>(point.x - points.front().x);
      near.y[i] = static_cast<std::int32_t>(point.y - points.front().y);
    }
    const PointSum sum{{coefficients_.data(), static_cast<std::int32_t>(row_stride_), reach_},
                       kernel_stride_,
                       impacts,
                       points.front(),
                       near,
                       derivative,
                       out.data() + done * static_cast<std::size_t>(lanes_)};
    if (lanes_ == 4) {
      add_impacts_of_four(order_, sum);
    } else {
      add_impacts_of_eight(order_, sum);
    }
  }
}

}  // namespace textonbench
