#include "methods/spot/spline_points.h"

#include <algorithm>
#include <cstring>

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
  std::int64_t row_stride;
  std::int64_t kernel_stride;
  Extent reach;
};

template <int order, int lanes>
void sum_taps(const TapTable& table, std::span<const PlaneImpact> impacts, std::span<const PlanePoint> points,
              Derivative derivative, float* out) {
  using Tap = typename TapVector<lanes>::Type;
  for (const PlanePoint& point : points) {
    const std::int64_t x = point.x + tap_offset(order);
    const std::int64_t y = point.y + tap_offset(order);
    Tap sum{};
    for (const PlaneImpact& impact : impacts) {
      const std::int64_t dx = x - impact.x;
      const std::int64_t dy = y - impact.y;
      const std::int64_t column = dx >> plane_bits;
      const std::int64_t row = dy >> plane_bits;
      if (column < 0 || column >= table.reach.width || row < 0 || row >= table.reach.height) {
        continue;
      }
      float wx[order + 1];
      float wy[order + 1];
      if constexpr (order > 0) {
        if (derivative == Derivative::x) {
          spline_slopes<order>(knot_position(dx), wx);
        } else {
          spline_weights<order>(knot_position(dx), wx);
        }
        if (derivative == Derivative::y) {
          spline_slopes<order>(knot_position(dy), wy);
        } else {
          spline_weights<order>(knot_position(dy), wy);
        }
      } else {
        wx[0] = 1;
        wy[0] = 1;
      }
      const float* from = table.data + impact.kernel * table.kernel_stride + row * table.row_stride + column * lanes;
      Tap value{};
      for (int j = 0; j <= order; ++j) {
        const Tap* taps = reinterpret_cast<const Tap*>(from + j * table.row_stride);
        Tap blend = wx[0] * taps[0];
        for (int i = 1; i <= order; ++i) {
          blend += wx[i] * taps[i];
        }
        value += wy[j] * blend;
      }
      sum += impact.weight * value;
    }
    std::memcpy(out, &sum, sizeof(sum));
    out += lanes;
  }
}

template <int lanes>
void sum_taps_of_order(int order, const TapTable& table, std::span<const PlaneImpact> impacts,
                       std::span<const PlanePoint> points, Derivative derivative, float* out) {
  switch (order) {
    case 0:
      return sum_taps<0, lanes>(table, impacts, points, derivative, out);
    case 1:
      return sum_taps<1, lanes>(table, impacts, points, derivative, out);
    case 2:
      return sum_taps<2, lanes>(table, impacts, points, derivative, out);
    case 3:
      return sum_taps<3, lanes>(table, impacts, points, derivative, out);
    case 4:
      return sum_taps<4, lanes>(table, impacts, points, derivative, out);
    default:
      return sum_taps<5, lanes>(table, impacts, points, derivative, out);
  }
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
        float* to = kernel_start + (y + frame) * row_stride_ + frame * lanes_ + c;
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
                       Derivative derivative, std::vector<float>& out) const {
  const auto [left, right] = std::ranges::minmax(points, {}, &PlanePoint::x);
  const auto [top, bottom] = std::ranges::minmax(points, {}, &PlanePoint::y);
  std::vector<PlaneImpact> impacts;
  grid.draw(key, reaching(order_, reach_, {left.x, top.y, right.x, bottom.y}), impacts);
  out.resize(points.size() * static_cast<std::size_t>(lanes_));
  const TapTable table{coefficients_.data(), row_stride_, kernel_stride_, reach_};
  if (lanes_ == 4) {
    sum_taps_of_order<4>(order_, table, impacts, points, derivative, out.data());
  } else {
    sum_taps_of_order<8>(order_, table, impacts, points, derivative, out.data());
  }
}

}  // namespace textonbench
