#include "experiments/metrics/spline_law.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "experiments/metrics/spot_samples.h"
#include "methods/base/bspline.h"

namespace textonbench {
namespace {

constexpr std::array<std::pair<double, double>, 3> gauss_nodes_and_weights{
    std::pair{0.2386191860831969, 0.4679139345726910}, std::pair{0.6612093864662645, 0.3607615730481386},
    std::pair{0.9324695142031521, 0.1713244923791704}};

/// First j with β(v − j) other than zero for a spline of that half width, within [-limit, limit], and the last.
std::pair<int, int> reached(double v, double half_width, int limit) {
  return {std::max(-limit, static_cast<int>(std::ceil(v - half_width))),
          std::min(limit, static_cast<int>(std::floor(v + half_width)))};
}

}  // namespace

const SplineTexton* single_spline_texton(const Model& model) {
  const SplineTexton* texton = model.spline_texton();
  if (texton == nullptr || texton->coefficients.kernels.size() != 1) return nullptr;
  const Image& kernel = texton->coefficients.kernels.front();
  for (int c = 0; c < kernel.channels(); ++c) {
    if (autocorrelation(kernel, c, 0, 0) == 0) return nullptr;
  }
  return texton;
}

double spline_correlation(int order, double x) {
  const double half_width = (order + 1) / 2.0;
  const double low = std::max(-half_width, -half_width - x), high = std::min(half_width, half_width - x);
  if (low >= high) return 0;
  std::vector<double> knots;
  knots.reserve(2 * static_cast<std::size_t>(order) + 4);
  for (int i = 0; i <= order + 1; ++i) {
    for (const double knot : {i - half_width, i - half_width - x}) knots.push_back(std::clamp(knot, low, high));
  }
  std::ranges::sort(knots);
  double sum = 0;
  for (std::size_t i = 1; i < knots.size(); ++i) {
    const double middle = (knots[i - 1] + knots[i]) / 2, half = (knots[i] - knots[i - 1]) / 2;
    for (const auto& [node, weight] : gauss_nodes_and_weights) {
      for (const double t : {middle - half * node, middle + half * node}) {
        sum += half * weight * bspline(order, t) * bspline(order, t + x);
      }
    }
  }
  return sum;
}

SplineCovariance::SplineCovariance(const SplineTexton& texton)
    : order_(texton.order), extent_(texton.coefficients.extent()) {
  const Image& kernel = texton.coefficients.kernels.front();
  for (int c = 0; c < kernel.channels(); ++c) {
    std::vector<double>& correlation = correlations_.emplace_back();
    for (int y = 1 - extent_.height; y < extent_.height; ++y) {
      for (int x = 1 - extent_.width; x < extent_.width; ++x) correlation.push_back(autocorrelation(kernel, c, x, y));
    }
  }
}

double SplineCovariance::at(int channel, double x, double y) const {
  const int right = extent_.width - 1, bottom = extent_.height - 1;
  const auto [first_x, last_x] = reached(x, order_ + 1, right);
  const auto [first_y, last_y] = reached(y, order_ + 1, bottom);
  std::vector<double> weights;
  for (int j = first_x; j <= last_x; ++j) weights.push_back(spline_correlation(order_, x - j));
  double sum = 0;
  for (int k = first_y; k <= last_y; ++k) {
    const std::ptrdiff_t row = std::ptrdiff_t{k + bottom} * (2 * right + 1) + right;
    double along_row = 0;
    for (int j = first_x; j <= last_x; ++j) {
      along_row += weights[static_cast<std::size_t>(j - first_x)] *
                   correlations_[static_cast<std::size_t>(channel)][static_cast<std::size_t>(row + j)];
    }
    sum += spline_correlation(order_, y - k) * along_row;
  }
  return sum;
}

double SplineCovariance::total(double x, double y) const {
  double sum = 0;
  for (int c = 0; c < channels(); ++c) sum += at(c, x, y);
  return sum;
}

double spline_kernel(const SplineTexton& texton, int channel, double x, double y) {
  const Image& kernel = texton.coefficients.kernels.front();
  const double half_width = (texton.order + 1) / 2.0;
  double sum = 0;
  for (int k = std::max(0, static_cast<int>(std::ceil(y - half_width)));
       k <= std::min(kernel.height() - 1, static_cast<int>(std::floor(y + half_width))); ++k) {
    const double weight = bspline(texton.order, y - k);
    for (int j = std::max(0, static_cast<int>(std::ceil(x - half_width)));
         j <= std::min(kernel.width() - 1, static_cast<int>(std::floor(x + half_width))); ++j) {
      sum += weight * bspline(texton.order, x - j) * kernel.at(channel, j, k);
    }
  }
  return sum;
}

}  // namespace textonbench
