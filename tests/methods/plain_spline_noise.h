// Texton noise as its definition reads: for each point a loop over the cells in reach, over their impacts and over the
// coefficients, in double precision.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "methods/base/bspline.h"
#include "methods/base/impact_grid.h"
#include "methods/base/texton.h"
#include "methods/method.h"

namespace textonbench {

/// Derivatives of β^n(x) for n >= 1.
inline double bspline_slope(int order, double x) { return bspline(order - 1, x + 0.5) - bspline(order - 1, x - 0.5); }

class PlainSplineNoise {
 public:
  PlainSplineNoise(const SplineTexton& texton, const ImpactGrid& grid, Seed seed)
      : texton_(texton), grid_(grid), key_(Stream(seed).child("texton noise").key()) {}

  double value(int channel, Point2 p) const {
    const Texton& coefficients = texton_.coefficients;
    const auto kernels = static_cast<double>(coefficients.kernels.size());
    double integral = 0;
    for (const Image& kernel : coefficients.kernels) {
      for (int y = 0; y < kernel.height(); ++y) {
        for (const float v : kernel.row(channel, y)) integral += v;
      }
    }
    const double sum = sum_at(p, [&](double dx, double dy, int k) { return kernel_at(channel, k, dx, dy, 0); });
    return coefficients.mean[static_cast<std::size_t>(channel)] +
           std::sqrt(kernels / grid_.intensity()) * (sum - grid_.mean_weight() / kernels * integral);
  }

  /// Along x (axis 1) or y (axis 2).
  double slope(int channel, Point2 p, int axis) const {
    const auto kernels = static_cast<double>(texton_.coefficients.kernels.size());
    return std::sqrt(kernels / grid_.intensity()) *
           sum_at(p, [&](double dx, double dy, int k) { return kernel_at(channel, k, dx, dy, axis); });
  }

 private:
  template <class Kernel>
  double sum_at(Point2 p, const Kernel& kernel) const {
    const double side = grid_.side();
    const Extent extent = texton_.coefficients.extent();
    const double half = (texton_.order + 1) / 2.0;
    const auto cell = [side](double x) { return static_cast<std::int64_t>(std::floor(x / side)); };
    double sum = 0;
    std::vector<CellImpact> impacts;
    for (std::int64_t cy = cell(p.y - extent.height - half); cy <= cell(p.y + half); ++cy) {
      for (std::int64_t cx = cell(p.x - extent.width - half); cx <= cell(p.x + half); ++cx) {
        impacts.clear();
        grid_.draw_cell(key_, cx, cy, impacts);
        for (const CellImpact& impact : impacts) {
          const double dx = (p.x - static_cast<double>(cx) * side) - impact.x * 0x1p-24 * side;
          const double dy = (p.y - static_cast<double>(cy) * side) - impact.y * 0x1p-24 * side;
          sum += impact.weight * kernel(dx, dy, impact.kernel);
        }
      }
    }
    return sum;
  }

  double kernel_at(int channel, int k, double dx, double dy, int axis) const {
    const Image& kernel = texton_.coefficients.kernels[static_cast<std::size_t>(k)];
    const int n = texton_.order;
    const double half = (n + 1) / 2.0;
    if (std::abs(dx - (kernel.width() - 1) / 2.0) > (kernel.width() - 1) / 2.0 + half ||
        std::abs(dy - (kernel.height() - 1) / 2.0) > (kernel.height() - 1) / 2.0 + half) {
      return 0;
    }
    double sum = 0;
    for (int y = 0; y < kernel.height(); ++y) {
      const double wy = axis == 2 ? bspline_slope(n, dy - y) : bspline(n, dy - y);
      for (int x = 0; x < kernel.width() && wy != 0; ++x) {
        sum += kernel.at(channel, x, y) * wy * (axis == 1 ? bspline_slope(n, dx - x) : bspline(n, dx - x));
      }
    }
    return sum;
  }

  const SplineTexton& texton_;
  ImpactGrid grid_;
  std::uint64_t key_;
};

}  // namespace textonbench
