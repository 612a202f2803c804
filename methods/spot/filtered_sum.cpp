#include "methods/spot/filtered_sum.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <utility>

#include "methods/spot/spline_place.h"

namespace textonbench {
namespace {

constexpr double furthest_coordinate = 0x1p40;

std::int64_t plane_coordinate(double x) {
  return static_cast<std::int64_t>(std::floor(x * static_cast<double>(plane_unit)));
}

double pixels(std::int64_t distance) { return static_cast<double>(distance) / static_cast<double>(plane_unit); }

/// By how much the window is larger than the coefficients' squares, on each side.
Eigen::Vector2d window_margin(const KernelFilter& kernel, ImpactWindow window) {
  return window == ImpactWindow::footprint ? kernel.margin() : Eigen::Vector2d(0.5, 0.5);
}

}  // namespace

FilteredSum::FilteredSum(SplineTexton texton, const SplineNoiseOptions& options)
    : texton_(std::move(texton)),
      grid_(spline_noise_impacts(texton_, options)),
      scale_(std::sqrt(static_cast<double>(texton_.coefficients.kernels.size()) / grid_.intensity())),
      start_(Eigen::Vector4d::Zero()) {
  if (texton_.order != 1) {
    throw std::invalid_argument(
        fmt::format("filtered noise of order {}: mip chains are of bilinear kernels, expected order 1", texton_.order));
  }
  const std::vector<Image>& kernels = texton_.coefficients.kernels;
  chains_.reserve(kernels.size());
  for (const Image& kernel : kernels) chains_.emplace_back(kernel);
  const double expected = scale_ * grid_.mean_weight() / static_cast<double>(kernels.size());
  for (int c = 0; c < texton_.coefficients.channels(); ++c) {
    double integral = 0;
    for (const Image& kernel : kernels) {
      for (int y = 0; y < kernel.height(); ++y) {
        for (const float v : kernel.row(c, y)) integral += v;
      }
    }
    start_[c] = texton_.coefficients.mean[static_cast<std::size_t>(c)] - expected * integral;
  }
}

Eigen::Vector4d FilteredSum::evaluate(const Eigen::Vector2d& point, const Eigen::Matrix2d& footprint,
                                      TextonFilter filter, ImpactWindow window, std::uint64_t key,
                                      std::vector<PlaneImpact>& impacts) const {
  if (!(point.cwiseAbs().maxCoeff() <= furthest_coordinate)) {
    throw std::invalid_argument(fmt::format(
        "filtered noise at ({}, {}): expected a point within 2^40 pixels of the origin", point.x(), point.y()));
  }
  const KernelFilter kernel(filter, footprint, chains_.front().coarsest());
  const Eigen::Vector2d margin = window_margin(kernel, window);
  const Extent box = texton_.coefficients.extent();
  const std::int64_t x = plane_coordinate(point.x());
  const std::int64_t y = plane_coordinate(point.y());
  impacts.clear();
  grid_.draw(key,
             {x - plane_coordinate(box.width - 0.5 + margin.x()), y - plane_coordinate(box.height - 0.5 + margin.y()),
              x + plane_coordinate(0.5 + margin.x()), y + plane_coordinate(0.5 + margin.y())},
             impacts);
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  for (const PlaneImpact& impact : impacts) {
    const Texel value =
        kernel(chains_[static_cast<std::size_t>(impact.kernel)], pixels(x - impact.x), pixels(y - impact.y));
    sum += impact.weight * value.cast<double>();
  }
  return start_ + scale_ * sum;
}

double FilteredSum::operations(const Eigen::Matrix2d& footprint, TextonFilter filter, ImpactWindow window) const {
  const KernelFilter kernel(filter, footprint, chains_.front().coarsest());
  const Eigen::Vector2d margin = window_margin(kernel, window);
  const Extent box = texton_.coefficients.extent();
  const double impacts = grid_.intensity() * (box.width + 2 * margin.x()) * (box.height + 2 * margin.y());
  return impacts * kernel.texels() * 2 * texton_.coefficients.channels();
}

std::size_t FilteredSum::bytes() const {
  std::size_t bytes = 0;
  for (const MipChain& chain : chains_) bytes += chain.bytes();
  return bytes;
}

}  // namespace textonbench
