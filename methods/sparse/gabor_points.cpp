#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <vector>

#include "methods/base/aligned_buffer.h"
#include "methods/base/image.h"
#include "methods/base/parallel.h"
#include "methods/sparse/gabor_point_sum.h"
#include "methods/sparse/gabor_sum.h"

namespace textonbench {
namespace {

/// Points that are sorted together.
constexpr std::size_t sorted_points = std::size_t{1} << 16;
/// Of one task: more draw fewer impacts twice, fewer leave work for more threads.
constexpr std::size_t least_tree_points = 256, most_tree_points = 4096, wanted_tasks = 16;
/// Side of the greatest rectangle whose impacts are drawn at a time, pixels.
constexpr double widest_draw = 8192;

/// From the lower to the higher of two coordinates, which may be more than a signed number holds.
std::uint64_t plane_distance(std::int64_t low, std::int64_t high) {
  return static_cast<std::uint64_t>(high) - static_cast<std::uint64_t>(low);
}

/// Bits of two 8-bit numbers by turns, the first 16 bits below the second.
std::uint32_t spread_bits(std::uint32_t v) {
  v = (v | v << 4U) & 0x0F0F0F0FU;
  v = (v | v << 2U) & 0x33333333U;
  v = (v | v << 1U) & 0x55555555U;
  return (v | v >> 15U) & 0xFFFFU;
}

/// Numbers of the points, from `first` on, along Morton's curve through 256 x 256 squares around all of them.
void order_by_curve(std::span<const WavePoint> points, std::uint32_t first, std::uint32_t* order) {
  WavePoint low = points.front(), high = low;
  for (const WavePoint& p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const auto widest = std::max(plane_distance(low.x, high.x), plane_distance(low.y, high.y));
  unsigned shift = 0;
  while (widest >> shift >= 256) ++shift;
  // Two passes of a sort by counting, by halves of the key, which is above the number.
  AlignedBuffer<std::uint64_t> keys(points.size()), half(points.size());
  std::array<std::array<std::uint32_t, 257>, 2> next{};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto x = plane_distance(low.x, points[i].x) >> shift;
    const auto y = plane_distance(low.y, points[i].y) >> shift;
    const std::uint32_t key = spread_bits(static_cast<std::uint32_t>(x | y << 16U));
    keys.data()[i] = std::uint64_t{key} << 32U | i;
    ++next[0][(key & 255U) + 1], ++next[1][(key >> 8U) + 1];
  }
  for (std::size_t pass = 0; pass < 2; ++pass) {
    for (std::size_t i = 1; i < next[pass].size(); ++i) next[pass][i] += next[pass][i - 1];
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint64_t key = keys.data()[i];
    half.data()[next[0][key >> 32U & 255U]++] = key;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint64_t key = half.data()[i];
    order[next[1][key >> 40U]++] = first + static_cast<std::uint32_t>(key);
  }
}

/// A rectangle around points, 2^−22 pixel; none of them where it is inside out.
struct PointBox {
  std::int64_t left = std::numeric_limits<std::int64_t>::max(), top = left;
  std::int64_t right = std::numeric_limits<std::int64_t>::min(), bottom = right;

  bool is_empty() const { return left > right; }
  double width() const { return static_cast<double>(plane_distance(left, right)) / plane_pixel; }
  double height() const { return static_cast<double>(plane_distance(top, bottom)) / plane_pixel; }
  static PointBox of(const PointBox& a, const PointBox& b) {
    PointBox both;
    both.left = std::min(a.left, b.left), both.top = std::min(a.top, b.top);
    both.right = std::max(a.right, b.right), both.bottom = std::max(a.bottom, b.bottom);
    return both;
  }
};

/// A binary tree over points in their order: node n has the children 2n and 2n + 1, and the points are the last level.
/// Impacts are drawn for nodes whose rectangle costs less than its halves do.
class PointTree {
 public:
  PointTree(std::span<const WavePoint> points, std::span<const std::uint32_t> order, int channels)
      : order_(order), outputs_(points.size()), channels_(channels) {
    points_.reserve(order.size());
    for (const std::uint32_t i : order) points_.push_back(points[i]);
    while (leaves_ < order.size()) leaves_ *= 2;
    boxes_.resize(leaves_), is_cut_.resize(2 * leaves_);
    for (std::size_t n = leaves_ - 1; n > 0; --n) boxes_[n] = PointBox::of(box_of(2 * n), box_of(2 * n + 1));
    sums_.assign(static_cast<std::size_t>(channels) * (leaves_ + GaborPoints::most), 0.0F);
  }

  void add(const GaborShape& shape, GaborImpacts& drawer) {
    plan(1, shape);
    add_planned(1, shape, drawer);
  }

  void write(std::span<float> out) const {
    for (std::size_t i = 0; i < order_.size(); ++i) {
      for (std::size_t c = 0; c < static_cast<std::size_t>(channels_); ++c) {
        out[c * outputs_ + order_[i]] = sums_[place(i) + c * GaborPoints::most];
      }
    }
  }

 private:
  PointBox box_of(std::size_t node) const {
    if (node < leaves_) return boxes_[node];
    PointBox box;
    if (node - leaves_ >= order_.size()) return box;
    const WavePoint& p = points_[node - leaves_];
    box.left = box.right = p.x, box.top = box.bottom = p.y;
    return box;
  }

  /// Of the sums of point i: vectors of points, channel after channel.
  std::size_t place(std::size_t i) const {
    constexpr std::size_t most = GaborPoints::most;
    return i / most * most * static_cast<std::size_t>(channels_) + i % most;
  }

  /// The least area that the impacts of a node are drawn in, square pixels, with the cells at its rim.
  double plan(std::size_t node, const GaborShape& shape) {
    const PointBox box = box_of(node);
    is_cut_[node] = 0;
    if (box.is_empty()) return 0;
    const double around_x = 2 * shape.half_width + shape.cell, around_y = 2 * shape.half_height + shape.cell;
    const double width = box.width(), height = box.height(), whole = (width + around_x) * (height + around_y);
    const bool is_too_wide = std::max(width, height) > widest_draw;
    if (node >= leaves_ || (!is_too_wide && whole <= 1.5 * around_x * around_y)) return whole;
    const double halves = plan(2 * node, shape) + plan(2 * node + 1, shape);
    if (!is_too_wide && whole <= halves) return whole;
    is_cut_[node] = 1;
    return halves;
  }

  void add_planned(std::size_t node, const GaborShape& shape, GaborImpacts& drawer) {
    const PointBox box = box_of(node);
    if (box.is_empty()) return;
    if (is_cut_[node] != 0) {
      add_planned(2 * node, shape, drawer), add_planned(2 * node + 1, shape, drawer);
      return;
    }
    origin_x_ = whole_pixels(box.left), origin_y_ = whole_pixels(box.top);
    drawn_.clear(), near_.clear();
    drawer.draw({box.left - shape.reach_x, box.top - shape.reach_y, box.right + shape.reach_x + 1,
                 box.bottom + shape.reach_y + 1},
                drawn_);
    ImpactChoice& all = choices_[0];
    all.resize(drawn_.size());
    near_.reserve(drawn_.size());
    for (std::size_t i = 0; i < drawn_.size(); ++i) {
      NearImpact& impact = near_.emplace_back(near_impact(drawn_[i], origin_x_, origin_y_));
      impact.weight *= shape.cut;
      all.x[i] = static_cast<float>(impact.x) + impact.part_x;
      all.y[i] = static_cast<float>(impact.y) + impact.part_y;
      all.number[i] = static_cast<std::uint32_t>(i);
    }
    std::size_t first = node, count = 1;
    while (first < leaves_) first *= 2, count *= 2;
    if (count <= GaborPoints::most) {
      add_points(first - leaves_, count, all, shape);
    } else {
      add_parts(node, first - leaves_, count, 0, shape);
    }
  }

  /// Of the node over `count` places from `first` on.
  void add_node(std::size_t node, std::size_t first, std::size_t count, std::size_t level, const GaborShape& shape) {
    const PointBox box = box_of(node);
    if (box.is_empty()) return;
    const auto pixels = [](std::int64_t at, std::int64_t origin) {
      return static_cast<double>(at - origin * plane_pixel) / plane_pixel;
    };
    const PixelBox reached{.x = static_cast<float>(pixels(box.left, origin_x_) + box.width() / 2),
                           .y = static_cast<float>(pixels(box.top, origin_y_) + box.height() / 2),
                           .half_width = static_cast<float>(box.width() / 2),
                           .half_height = static_cast<float>(box.height() / 2)};
    choose_impacts(shape, reached, choices_[level], choices_[level + 1]);
    if (choices_[level + 1].count == 0) return;
    if (count <= GaborPoints::most) {
      add_points(first, count, choices_[level + 1], shape);
      return;
    }
    add_parts(node, first, count, level + 1, shape);
  }

  /// Of such a node the parts, each with those of the impacts chosen for the node that may reach it.
  void add_parts(std::size_t node, std::size_t first, std::size_t count, std::size_t level, const GaborShape& shape) {
    const std::size_t parts = std::min<std::size_t>(16, count / GaborPoints::most);
    for (std::size_t i = 0; i < parts; ++i) {
      add_node(parts * node + i, first + count / parts * i, count / parts, level, shape);
    }
  }

  void add_points(std::size_t first, std::size_t count, const ImpactChoice& chosen, const GaborShape& shape) {
    GaborPoints some;
    count = std::min(count, order_.size() - first);
    for (std::size_t i = 0; i < GaborPoints::most; ++i) {
      const WavePoint& p = points_[first + (i < count ? i : 0)];
      some.x[i] = static_cast<std::int32_t>(whole_pixels(p.x) - origin_x_);
      some.y[i] = static_cast<std::int32_t>(whole_pixels(p.y) - origin_y_);
      some.part_x[i] = part_of_pixel(p.x), some.part_y[i] = part_of_pixel(p.y);
    }
    if (first % GaborPoints::most == 0 && count == GaborPoints::most) {
      add_impacts(shape, some, near_, chosen, sums_.data() + place(first));
      return;
    }
    alignas(64) float sums[Image::max_channels * GaborPoints::most] = {};
    const std::size_t numbers = static_cast<std::size_t>(channels_) * GaborPoints::most;
    for (std::size_t at = 0; at < numbers; at += GaborPoints::most) {
      std::copy_n(sums_.data() + place(first) + at, count, sums + at);
    }
    add_impacts(shape, some, near_, chosen, sums);
    for (std::size_t at = 0; at < numbers; at += GaborPoints::most) {
      std::copy_n(sums + at, count, sums_.data() + place(first) + at);
    }
  }

  std::span<const std::uint32_t> order_;
  std::size_t outputs_;  // of a channel
  std::vector<WavePoint> points_;
  int channels_;
  std::size_t leaves_ = 1;
  std::vector<PointBox> boxes_;  // of the nodes that are not points
  std::vector<char> is_cut_;
  std::vector<float> sums_;
  std::int64_t origin_x_ = 0, origin_y_ = 0;  // of what was drawn, pixels
  std::vector<GaborImpact> drawn_;
  std::vector<NearImpact> near_;
  std::array<ImpactChoice, 4> choices_;  // of all those drawn, and of the nodes down to a vector of points
};

}  // namespace

void sum_gabor(const GaborField& field, Seed seed, std::span<const WavePoint> points, std::span<float> out) {
  if (points.empty()) return;
  std::vector<GaborShape> shapes;
  shapes.reserve(field.bands.size());
  for (const GaborBand& band : field.bands) shapes.emplace_back(field, band);
  const AlignedBuffer<std::uint32_t> order(points.size());
  parallel_for(static_cast<int>((points.size() + sorted_points - 1) / sorted_points), [&](int block) {
    const std::size_t first = static_cast<std::size_t>(block) * sorted_points;
    order_by_curve(points.subspan(first, std::min(sorted_points, points.size() - first)),
                   static_cast<std::uint32_t>(first), order.data() + first);
  });
  const std::size_t tree_points =
      std::clamp(std::bit_floor(points.size() / wanted_tasks), least_tree_points, most_tree_points);
  parallel_for(static_cast<int>((points.size() + tree_points - 1) / tree_points), [&](int task) {
    const std::size_t first = static_cast<std::size_t>(task) * tree_points;
    PointTree tree(points, {order.data() + first, std::min(tree_points, points.size() - first)}, field.channels);
    for (std::size_t b = 0; b < shapes.size(); ++b) {
      GaborImpacts drawer(field, b, seed);
      tree.add(shapes[b], drawer);
    }
    tree.write(out);
  });
}

}  // namespace textonbench
