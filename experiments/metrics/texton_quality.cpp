#include "experiments/metrics/texton_quality.h"

#include <algorithm>

#include "methods/spot/color_correction.h"
#include "methods/spot/kernel_moments.h"
#include "methods/spot/optimal_texton.h"
#include "methods/spot/texton_mix.h"

namespace textonbench {
namespace {

constexpr double small_kurtosis = 0.1;

}  // namespace

Image support_mask(const Texton& texton) {
  Image mask(texton.extent(), 1);
  for (const Image& kernel : texton.kernels) {
    for (int c = 0; c < kernel.channels(); ++c) {
      for (int y = 0; y < kernel.height(); ++y) {
        const auto values = kernel.row(c, y);
        const auto inside = mask.row(0, y);
        for (std::size_t x = 0; x < values.size(); ++x) {
          if (values[x] != 0) inside[x] = 1;
        }
      }
    }
  }
  return mask;
}

std::optional<double> kept_variance(const Model& model, const Target& target, const Domain&) {
  if (model.texton() == nullptr) return std::nullopt;
  return color_covariance(*model.texton()).trace() / color_covariance(target.gaussian.spectrum).trace();
}

std::optional<double> rme_corrected(const Model& model, const Target& target, const Domain&) {
  if (model.texton() == nullptr) return std::nullopt;
  return correct_colors(*model.texton(), target.gaussian.spectrum, ColorCorrection::authors).rme_after;
}

std::optional<double> rme_bound(const Model& model, const Target& target, const Domain&) {
  if (model.texton() == nullptr) return std::nullopt;
  return bound_texton_error(target.gaussian, support_mask(*model.texton()), {}, Seed{1}).rme;
}

std::optional<double> kernel_kurtosis(const Model& model, const Target&, const Domain&) {
  const Texton* texton = model.texton();
  if (texton == nullptr) return std::nullopt;
  const std::vector<double> channels = kernel_kurtosis(texton->kernels, texton->support_pixels);
  return *std::ranges::max_element(channels);
}

std::optional<double> poisson_impacts(const Model& model, const Target&, const Domain&) {
  if (model.texton() == nullptr) return std::nullopt;
  return poisson_impacts_needed(*model.texton(), small_kurtosis);
}

std::optional<double> stratified_impacts(const Model& model, const Target&, const Domain&) {
  if (model.texton() == nullptr) return std::nullopt;
  return stratified_impacts_needed(*model.texton(), small_kurtosis);
}

}  // namespace textonbench
