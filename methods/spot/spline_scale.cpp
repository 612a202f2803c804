#include "methods/spot/spline_scale.h"

#include <cmath>

namespace textonbench {
namespace {

/// Σ_k ∫ h_k = Σ_k Σ_j α_k(j).
double sum_of_integrals(const SplineTexton& texton, int channel) {
  double sum = 0;
  for (const Image& kernel : texton.coefficients.kernels) {
    for (int y = 0; y < kernel.height(); ++y) {
      for (const float v : kernel.row(channel, y)) {
        sum += v;
      }
    }
  }
  return sum;
}

}  // namespace

double spline_noise_scale(const SplineTexton& texton, const SplineNoiseOptions& options, const ImpactGrid& grid) {
  return std::sqrt((options.share ? 1.0 : static_cast<double>(texton.coefficients.kernels.size())) / grid.intensity());
}

std::vector<float> spline_noise_start(const SplineTexton& texton, double scale, const ImpactGrid& grid) {
  const auto kernels = static_cast<double>(texton.coefficients.kernels.size());
  std::vector<float> start;
  start.reserve(texton.coefficients.mean.size());
  for (int c = 0; c < texton.coefficients.channels(); ++c) {
    const double expected = scale * grid.mean_weight() / kernels * sum_of_integrals(texton, c);
    start.push_back(static_cast<float>(texton.coefficients.mean[static_cast<std::size_t>(c)] - expected));
  }
  return start;
}

}  // namespace textonbench
