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
constexpr std::size_t points_a_task = 8192;
/// Points that a square of the plane is to hold, so that its impacts are drawn once for all of them.
constexpr double points_a_square = 48;

/// Some points, in the order of squares of the plane, and where each square's begin.
struct PointSquares {
  std::vector<std::uint32_t> order;
  std::vector<std::size_t> first;  ///< and the end
};

std::int64_t floor_quotient(std::int64_t a, std::int64_t b) { return a / b - (a % b != 0 && (a < 0) != (b < 0)); }

/// Squares of at least a quarter of the kernels' box and at most the whole, by the density of the points.
PointSquares squares_of(std::span<const WavePoint> points, const GaborShape& shape) {
  WavePoint low = points.front(), high = low;
  for (const WavePoint& p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const double area = (static_cast<double>(high.x - low.x) + 1) * (static_cast<double>(high.y - low.y) + 1);
  const std::int64_t reach = std::max(shape.reach_x, shape.reach_y);
  const double wanted = std::sqrt(area * points_a_square / static_cast<double>(points.size()));
  const auto side =
      static_cast<std::int64_t>(std::clamp(wanted, static_cast<double>(reach) / 2, 2 * static_cast<double>(reach)));
  std::vector<std::pair<std::int64_t, std::int64_t>> square;
  square.reserve(points.size());
  for (const WavePoint& p : points) square.emplace_back(floor_quotient(p.y, side), floor_quotient(p.x, side));
  PointSquares squares;
  squares.order.resize(points.size());
  std::iota(squares.order.begin(), squares.order.end(), 0U);
  std::ranges::stable_sort(squares.order, {}, [&](std::uint32_t i) { return square[i]; });
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i == 0 || square[squares.order[i]] != square[squares.order[i - 1]]) squares.first.push_back(i);
  }
  squares.first.push_back(points.size());
  return squares;
}

/// part of a kernel at places where its form is below the limit.
__attribute__((target_clones("default", "avx2", "avx512f"))) void add_at_places(
    float limit, const std::complex<float>& color, float weight, const float* column_form, const float* row_form,
    const float* column_real, const float* column_imaginary, const float* row_real, const float* row_imaginary,
    int count, float* out) {
  for (int i = 0; i < count; ++i) {
    const float real = weight * (color.real() * row_real[i] - color.imag() * row_imaginary[i]);
    const float imaginary = weight * (color.real() * row_imaginary[i] + color.imag() * row_real[i]);
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
    x_.clear(), y_.clear();
    for (const std::uint32_t i : order) x_.push_back(points[i].x), y_.push_back(points[i].y);
    const auto room =
        static_cast<std::size_t>((count_ + KernelPlaces::block - 1) / KernelPlaces::block) * KernelPlaces::block;
    stride_ = room;
    sums_.assign(room * static_cast<std::size_t>(channels_), 0.0F);
    shifted_.resize(room);
  }
  PlaneRectangle box() const {
    const auto [left, right] = std::ranges::minmax(x_);
    const auto [top, bottom] = std::ranges::minmax(y_);
    return {left - shape_.reach_x, top - shape_.reach_y, right + shape_.reach_x + 1, bottom + shape_.reach_y + 1};
  }

  void add(const GaborImpact& impact) {
    rows_.resize(count_), columns_.resize(count_);
    bool reaches = false;
    for (int i = 0; i < count_; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const std::int64_t dx = x_[at] - impact.x, dy = y_[at] - impact.y;
      reaches = reaches || (std::abs(dx) < shape_.reach_x && std::abs(dy) < shape_.reach_y);
      const std::int64_t shift = shape_.shear == 0 ? 0 : std::llround(shape_.shear * static_cast<double>(dy));
      columns_.distance()[i] = place_distance(dx), rows_.distance()[i] = place_distance(dy);
      shifted_[at] = place_distance(dx + shift);
    }
    if (!reaches) return;
    const std::int32_t* frequency = shape_.frequency.data() + std::size_t{2} * impact.entry;
    rows_.set_waves(frequency[1], impact.phase);
    rows_.set_windows(shape_.across, rows_.distance());
    columns_.set_waves(frequency[0], 0);
    columns_.set_windows(shape_.along, shifted_.data());
    for (int c = 0; c < channels_; ++c) {
      const auto channel = static_cast<std::size_t>(c);
      add_at_places(shape_.limit,
                    band_.color[std::size_t{impact.entry} * static_cast<std::size_t>(channels_) + channel],
                    impact.weight, columns_.form(), rows_.form(), columns_.real(), columns_.imaginary(), rows_.real(),
                    rows_.imaginary(), count_, sums_.data() + channel * stride_);
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
  std::vector<std::int64_t> x_, y_;
  std::vector<std::int32_t> shifted_;
  std::vector<float> sums_;
  KernelPlaces rows_, columns_;
};

}  // namespace

void sum_gabor(const GaborField& field, Seed seed, std::span<const WavePoint> points, std::span<float> out) {
  std::ranges::fill(out, 0.0F);
  std::vector<GaborShape> shapes(field.bands.begin(), field.bands.end());
  const std::size_t total = points.size();
  for (std::size_t first = 0; first < total; first += points_a_task) {
    const std::size_t count = std::min(points_a_task, total - first);
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
