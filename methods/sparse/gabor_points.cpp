#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "methods/base/parallel.h"
#include "methods/sparse/gabor_kernel.h"
#include "methods/sparse/gabor_sum.h"

namespace textonbench {
namespace {

/// Points of a call that are grouped together.
constexpr std::size_t points_at_once = std::size_t{1} << 20;
/// Points that a square of the plane is to hold, so that its impacts are drawn once for all of them.
constexpr double points_a_square = 48;

/// Some points, in the order of squares of the plane, and where each square's begin.
struct PointSquares {
  std::vector<std::uint32_t> order;
  std::vector<std::size_t> first;  ///< and the end
};

/// Row and column of a square.
using SquareKey = std::pair<std::uint64_t, std::uint64_t>;

/// a − b of coordinates in order, which may be as far apart as 2^63.
std::uint64_t span_between(std::int64_t a, std::int64_t b) {
  return static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b);
}

std::vector<std::uint32_t> sorted_order(const std::vector<SquareKey>& keys) {
  std::vector<std::uint32_t> order(keys.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::stable_sort(order, {}, [&](std::uint32_t i) { return keys[i]; });
  return order;
}

/// The same where squares are few, in as many steps as there are of them and of points.
std::vector<std::uint32_t> counted_order(const std::vector<SquareKey>& keys, std::uint64_t across, std::uint64_t down) {
  const auto place = [&](const SquareKey& key) { return key.first * across + key.second; };
  std::vector<std::uint32_t> next(across * down + 1), order(keys.size());
  for (const SquareKey& key : keys) ++next[place(key) + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  for (std::uint32_t i = 0; i < keys.size(); ++i) order[next[place(keys[i])]++] = i;
  return order;
}

/// Squares of at least a quarter of the kernels' box and at most the whole, by the density of the points.
PointSquares squares_of(std::span<const WavePoint> points, const GaborShape& shape) {
  WavePoint low = points.front(), high = low;
  for (const WavePoint& p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const double area =
      (static_cast<double>(span_between(high.x, low.x)) + 1) * (static_cast<double>(span_between(high.y, low.y)) + 1);
  const std::int64_t reach = std::max(shape.reach_x, shape.reach_y);
  const double wanted = std::sqrt(area * points_a_square / static_cast<double>(points.size()));
  const auto side =
      static_cast<std::uint64_t>(std::clamp(wanted, static_cast<double>(reach) / 2, 2 * static_cast<double>(reach)));
  const std::uint64_t across = span_between(high.x, low.x) / side + 1, down = span_between(high.y, low.y) / side + 1;
  std::vector<SquareKey> square;
  square.reserve(points.size());
  for (const WavePoint& p : points)
    square.emplace_back(span_between(p.y, low.y) / side, span_between(p.x, low.x) / side);
  PointSquares squares;
  const bool are_few =
      static_cast<double>(across) * static_cast<double>(down) <= 8.0 * static_cast<double>(points.size());
  squares.order = are_few ? counted_order(square, across, down) : sorted_order(square);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i == 0 || square[squares.order[i]] != square[squares.order[i - 1]]) squares.first.push_back(i);
  }
  squares.first.push_back(points.size());
  return squares;
}

/// Distances of places from a kernel's middle, and those along x of a sheared window; whether any is in its box.
__attribute__((target_clones("default", "avx2", "avx512f"))) bool set_distances(
    const std::int32_t* x, const std::int32_t* y, std::int32_t middle_x, std::int32_t middle_y, std::int32_t reach_x,
    std::int32_t reach_y, double shear, int count, std::int32_t* column, std::int32_t* row, std::int32_t* shifted) {
  int inside = 0;
  if (shear != 0) {
    for (int i = 0; i < count; ++i) {
      // Of places far outside the window the sum may leave 32 bits, and they are cut for their distance along y.
      shifted[i] = static_cast<std::int32_t>(static_cast<std::uint32_t>(x[i] - middle_x) +
                                             static_cast<std::uint32_t>(sheared(shear, y[i] - middle_y)));
    }
  }
  for (int i = 0; i < count; ++i) {
    const std::int32_t dx = x[i] - middle_x, dy = y[i] - middle_y;
    inside |= static_cast<int>(dx < reach_x) & static_cast<int>(-dx < reach_x) & static_cast<int>(dy < reach_y) &
              static_cast<int>(-dy < reach_y);
    column[i] = dx, row[i] = dy;
  }
  return inside != 0;
}

/// Part of a kernel at places where its form is below the limit.
__attribute__((target_clones("default", "avx2", "avx512f"))) void add_at_places(
    float limit, const std::complex<float>& color, float weight, const KernelPlaces& columns, const KernelPlaces& rows,
    float* __restrict out) {
  const float *column_form = columns.form(), *row_form = rows.form(), *column_real = columns.real(),
              *column_imaginary = columns.imaginary(), *row_real = rows.real(), *row_imaginary = rows.imaginary();
  const float color_real = color.real(), color_imaginary = color.imag();
  const int count = columns.count();
  for (int i = 0; i < count; ++i) {
    const float real = weight * (color_real * row_real[i] - color_imaginary * row_imaginary[i]);
    const float imaginary = weight * (color_real * row_imaginary[i] + color_imaginary * row_real[i]);
    const float value = real * column_real[i] - imaginary * column_imaginary[i];
    out[i] += column_form[i] < limit - row_form[i] ? value : 0.0F;
  }
}

/// Kernels of a band at the points of a square.
class KernelPoints {
 public:
  KernelPoints(const GaborField& field, const GaborBand& band, const GaborShape& shape)
      : channels_(field.channels), band_(band), shape_(shape) {}

  /// Starts sums of zero at the points of that order.
  void start(std::span<const WavePoint> points, std::span<const std::uint32_t> order) {
    count_ = static_cast<int>(order.size());
    base_ = points[order.front()];
    low_ = high_ = base_;
    x_.clear(), y_.clear();
    for (const std::uint32_t i : order) {
      const WavePoint& p = points[i];
      low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y)};
      high_ = {std::max(high_.x, p.x), std::max(high_.y, p.y)};
      x_.push_back(place_distance(p.x, base_.x)), y_.push_back(place_distance(p.y, base_.y));
    }
    const auto room =
        static_cast<std::size_t>((count_ + KernelPlaces::block - 1) / KernelPlaces::block) * KernelPlaces::block;
    stride_ = room;
    sums_.assign(room * static_cast<std::size_t>(channels_), 0.0F);
    shifted_.resize(room);
  }
  PlaneRectangle box() const {
    return {low_.x - shape_.reach_x, low_.y - shape_.reach_y, high_.x + shape_.reach_x + 1,
            high_.y + shape_.reach_y + 1};
  }

  void add(const GaborImpact& impact) {
    rows_.resize(count_), columns_.resize(count_);
    std::int32_t *along = columns_.distance(), *across = rows_.distance();
    const auto reach_x = static_cast<std::int32_t>(place_coordinate(shape_.reach_x)) + 2;
    const auto reach_y = static_cast<std::int32_t>(place_coordinate(shape_.reach_y)) + 2;
    if (!set_distances(x_.data(), y_.data(), place_distance(impact.x, base_.x), place_distance(impact.y, base_.y),
                       reach_x, reach_y, shape_.shear, count_, along, across, shifted_.data())) {
      return;
    }
    if (shape_.shear != 0) along = shifted_.data();
    const std::int32_t* frequency = shape_.frequency.data() + std::size_t{2} * impact.entry;
    rows_.set_waves(frequency[1], impact.phase);
    rows_.set_windows(shape_.across, rows_.distance(), 0, count_);
    columns_.set_waves(frequency[0], 0);
    columns_.set_windows(shape_.along, along, 0, count_);
    for (int c = 0; c < channels_; ++c) {
      const auto channel = static_cast<std::size_t>(c);
      const std::size_t entry = std::size_t{impact.entry} * static_cast<std::size_t>(channels_);
      add_at_places(shape_.limit, band_.color[entry + channel], impact.weight, columns_, rows_,
                    sums_.data() + channel * stride_);
    }
  }

  /// out[c * total + order[i]] += the sum at point i.
  void finish(std::span<const std::uint32_t> order, std::size_t total, std::span<float> out) const {
    for (std::size_t c = 0; c < static_cast<std::size_t>(channels_); ++c) {
      for (std::size_t i = 0; i < order.size(); ++i) out[c * total + order[i]] += sums_[c * stride_ + i];
    }
  }

 private:
  int channels_;
  const GaborBand& band_;
  const GaborShape& shape_;
  int count_ = 0;
  std::size_t stride_ = 0;
  WavePoint base_, low_, high_;
  std::vector<std::int32_t> x_, y_;  ///< from the base, 2^−20 pixel
  std::vector<std::int32_t> shifted_;
  std::vector<float> sums_;
  KernelPlaces rows_, columns_;
};

}  // namespace

void sum_gabor(const GaborField& field, Seed seed, std::span<const WavePoint> points, std::span<float> out) {
  std::ranges::fill(out, 0.0F);
  std::vector<GaborShape> shapes(field.bands.begin(), field.bands.end());
  const std::size_t total = points.size();
  for (std::size_t first = 0; first < total; first += points_at_once) {
    const std::size_t count = std::min(points_at_once, total - first);
    const std::span<const WavePoint> some = points.subspan(first, count);
    for (std::size_t b = 0; b < field.bands.size(); ++b) {
      const PointSquares squares = squares_of(some, shapes[b]);
      parallel_for(static_cast<int>(squares.first.size()) - 1, [&](int s) {
        const std::size_t from = squares.first[static_cast<std::size_t>(s)];
        const std::span<const std::uint32_t> order(squares.order.data() + from,
                                                   squares.first[static_cast<std::size_t>(s) + 1] - from);
        KernelPoints kernel(field, field.bands[b], shapes[b]);
        kernel.start(some, order);
        std::vector<GaborImpact> impacts;
        GaborImpacts(field, b, seed).draw(kernel.box(), impacts);
        for (const GaborImpact& impact : impacts) kernel.add(impact);
        kernel.finish(order, total, out.subspan(first));
      });
    }
  }
}

}  // namespace textonbench
