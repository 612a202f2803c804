#include "methods/spot/surface_sum.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string_view>

#include "methods/base/bspline.h"
#include "methods/base/parallel.h"

namespace textonbench {
namespace {

using Eigen::Vector3d;

double require_between(std::string_view what, double value, double least, double most) {
  if (!(value >= least && value <= most)) {
    throw std::invalid_argument(fmt::format("surface noise: {} {}, expected {} to {}", what, value, least, most));
  }
  return value;
}

double longer_side(const SplineTexton& texton) {
  const Extent box = texton.coefficients.extent();
  return std::max(box.width, box.height) + texton.order;
}

double intensity_of(const SplineTexton& texton, double mni) {
  require_between("mean number of impacts", mni, 1e-3, 1e4);
  return mni / (texton.support_area * longer_side(texton));
}

/// Random words 4j … 4j + 3 of a cell.
std::array<std::uint32_t, 4> words_of(const Stream& stream, std::int32_t cx, std::int32_t cy, std::int32_t cz,
                                      std::uint32_t j) {
  const auto pack = [](std::uint32_t low, std::uint32_t high) { return std::uint64_t{high} << 32 | low; };
  return stream.block(pack(static_cast<std::uint32_t>(cx), static_cast<std::uint32_t>(cy)),
                      pack(static_cast<std::uint32_t>(cz), j));
}

/// Runs of consecutive points whose bounding box is no longer than `reach`.
std::vector<std::span<const SurfacePoint>> runs_of(std::span<const SurfacePoint> points, double reach) {
  constexpr std::size_t longest = 256;
  std::vector<std::span<const SurfacePoint>> runs;
  std::size_t first = 0;
  while (first < points.size()) {
    Vector3d low = points[first].position;
    Vector3d high = low;
    std::size_t end = first + 1;
    for (; end < std::min(points.size(), first + longest); ++end) {
      low = low.cwiseMin(points[end].position);
      high = high.cwiseMax(points[end].position);
      if ((high - low).maxCoeff() > reach) {
        break;
      }
    }
    runs.push_back(points.subspan(first, end - first));
    first = end;
  }
  return runs;
}

}  // namespace

SpaceGrid::SpaceGrid(ImpactProcess process, double intensity, double side, int kernels)
    : process_(process),
      intensity_(intensity),
      side_(process == ImpactProcess::stratified ? std::cbrt(1 / intensity) : side),
      kernels_(static_cast<std::uint32_t>(kernels)) {
  if (process != ImpactProcess::poisson && process != ImpactProcess::stratified) {
    throw std::invalid_argument("surface noise: expected poisson or stratified impacts");
  }
  if (process == ImpactProcess::poisson) {
    thresholds_ = poisson_thresholds(
        require_between("mean number of impacts a cell", intensity * side * side * side, 0, max_cell_mean));
  }
}

void SpaceGrid::draw_cell(const Stream& stream, std::int32_t cx, std::int32_t cy, std::int32_t cz,
                          std::vector<SurfaceImpact>& impacts) const {
  const std::array<std::uint32_t, 4> head = words_of(stream, cx, cy, cz, 0);
  std::uint32_t count = 1;
  float weight = 1;
  if (process_ == ImpactProcess::poisson) {
    count = static_cast<std::uint32_t>(std::ranges::upper_bound(thresholds_, head[0]) - thresholds_.begin());
  } else {
    weight = (head[0] >> 31) != 0 ? -1.0F : 1.0F;
  }
  for (std::uint32_t i = 1; i <= count; ++i) {
    const std::array<std::uint32_t, 4> words = words_of(stream, cx, cy, cz, i);
    const auto coordinate = [&](std::int32_t cell, std::uint32_t word) { return (cell + word * 0x1p-32) * side_; };
    impacts.push_back({.position = {coordinate(cx, words[0]), coordinate(cy, words[1]), coordinate(cz, words[2])},
                       .kernel = static_cast<std::int32_t>(std::uint64_t{words[3]} * kernels_ >> 32),
                       .weight = weight});
  }
}

SurfaceSum::SurfaceSum(SplineTexton texton, const SurfaceSumOptions& options)
    : texton_(std::move(texton)),
      thickness_(longer_side(texton_)),
      intensity_(intensity_of(texton_, options.mni)),
      grid_(options.impacts, intensity_, require_between("cell", options.cell, 0.05, 4) * thickness_,
            static_cast<int>(texton_.coefficients.kernels.size())),
      start_(texton_.coefficients.mean) {
  // An impact adds sqrt(K) h_k, each k with probability 1/K, and a B-spline has integral 1.
  const auto count = static_cast<double>(texton_.coefficients.kernels.size());
  const double scale =
      grid_.mean_weight() * (thickness_ / 2) / std::sqrt(count) / std::sqrt(intensity_ * thickness_ / 3);
  for (std::size_t c = 0; c < start_.size(); ++c) {
    for (const Image& kernel : texton_.coefficients.kernels) {
      for (int y = 0; y < kernel.height(); ++y) {
        const auto row = kernel.row(static_cast<int>(c), y);
        start_[c] -= scale * std::accumulate(row.begin(), row.end(), 0.0);
      }
    }
  }
}

double SurfaceSum::scale() const {
  return std::sqrt(static_cast<double>(texton_.coefficients.kernels.size())) / std::sqrt(intensity_ * thickness_ / 3);
}

std::uint64_t SurfaceSum::key(Seed seed) { return Stream(seed).child("surface").key(); }

void SurfaceSum::add(const SurfacePoint& point, const SurfaceImpact& impact, std::span<double> sums) const {
  const Vector3d d = point.position - impact.position;
  const double height = 1 - 2 / thickness_ * std::abs(d.dot(point.normal));
  if (height <= 0) {
    return;
  }
  const Image& kernel = texton_.coefficients.kernels[static_cast<std::size_t>(impact.kernel)];
  const double x = d.dot(point.u1) + (kernel.width() - 1) / 2.0;
  const double y = d.dot(point.u2) + (kernel.height() - 1) / 2.0;
  const double half = (texton_.order + 1) / 2.0;
  if (!(x > -half && x < kernel.width() - 1 + half && y > -half && y < kernel.height() - 1 + half)) {
    return;
  }
  const BsplineTaps taps_x = bspline_taps(texton_.order, x);
  const BsplineTaps taps_y = bspline_taps(texton_.order, y);
  for (int j = 0; j <= texton_.order; ++j) {
    const std::int64_t row = taps_y.first + j;
    if (row < 0 || row >= kernel.height()) {
      continue;
    }
    for (int i = 0; i <= texton_.order; ++i) {
      const std::int64_t column = taps_x.first + i;
      if (column < 0 || column >= kernel.width()) {
        continue;
      }
      const double weight = impact.weight * height * taps_x.weights[static_cast<std::size_t>(i)] *
                            taps_y.weights[static_cast<std::size_t>(j)];
      for (int c = 0; c < kernel.channels(); ++c) {
        sums[static_cast<std::size_t>(c)] += weight * kernel.at(c, static_cast<int>(column), static_cast<int>(row));
      }
    }
  }
}

void SurfaceSum::evaluate_near(std::span<const SurfacePoint> points, const Stream& stream,
                               std::span<double> sums) const {
  const auto channels = start_.size();
  // Every impact that reaches a point lies in the box of its frame, so within half a diagonal of it.
  Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity());
  Vector3d high = -low;
  for (const SurfacePoint& point : points) {
    const Vector3d reach =
        (point.u1.cwiseAbs() + point.u2.cwiseAbs() + point.normal.cwiseAbs()) * ((thickness_ + 1) / 2);
    low = low.cwiseMin(point.position - reach);
    high = high.cwiseMax(point.position + reach);
  }
  const auto first = [&](int axis) { return static_cast<std::int32_t>(std::floor(low[axis] / grid_.side())); };
  const auto last = [&](int axis) { return static_cast<std::int32_t>(std::floor(high[axis] / grid_.side())); };
  std::vector<SurfaceImpact> impacts;
  for (std::int32_t cz = first(2); cz <= last(2); ++cz) {
    for (std::int32_t cy = first(1); cy <= last(1); ++cy) {
      for (std::int32_t cx = first(0); cx <= last(0); ++cx) {
        grid_.draw_cell(stream, cx, cy, cz, impacts);
      }
    }
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (const SurfaceImpact& impact : impacts) {
      add(points[i], impact, sums.subspan(i * channels, channels));
    }
  }
}

void SurfaceSum::evaluate(std::span<const SurfacePoint> points, Seed seed, std::span<float> out) const {
  for (const SurfacePoint& point : points) {
    if (!point.position.allFinite() || point.position.cwiseAbs().maxCoeff() > furthest_coordinate) {
      throw std::invalid_argument(fmt::format("surface noise: point ({}, {}, {}), expected coordinates within ±{}",
                                              point.position.x(), point.position.y(), point.position.z(),
                                              furthest_coordinate));
    }
  }
  const Stream stream = Stream(seed).child("surface");
  const std::size_t channels = start_.size();
  const double of_kernels = scale();
  const auto runs = runs_of(points, thickness_ / 4);
  parallel_for(static_cast<int>(runs.size()), [&](int run) {
    const std::span<const SurfacePoint> near = runs[static_cast<std::size_t>(run)];
    std::vector<double> sums(near.size() * channels);
    evaluate_near(near, stream, sums);
    const auto first = static_cast<std::size_t>(near.data() - points.data());
    for (std::size_t i = 0; i < near.size(); ++i) {
      for (std::size_t c = 0; c < channels; ++c) {
        out[c * points.size() + first + i] = static_cast<float>(start_[c] + of_kernels * sums[i * channels + c]);
      }
    }
  });
}

}  // namespace textonbench
