#include "experiments/metrics/texton_quality.h"

#include <algorithm>
#include <limits>

#include "methods/spot/color_correction.h"
#include "methods/spot/kernel_moments.h"
#include "methods/spot/optimal_texton.h"
#include "methods/spot/spline_moments.h"
#include "methods/spot/spline_noise.h"
#include "methods/spot/spot_noise.h"

namespace textonbench {
namespace {

constexpr double small_kurtosis = 0.1;

/// What a model sums: kernels on Z², or the coefficients of B-splines.
struct SummedTexton {
  const Texton* texton = nullptr;  ///< nothing when it sums neither
  int order = 0;                   ///< of the splines; 0 for kernels on Z², whose noise there has the same law
};

SummedTexton summed_texton(const Model& model) {
  const SplineTexton* spline = model.spline_texton();
  return spline != nullptr ? SummedTexton{&spline->coefficients, spline->order} : SummedTexton{model.texton()};
}

CellLattice lattice_of(const SpotNoiseOptions& noise, const Texton& texton, const Domain& domain) {
  return impact_lattice(noise.mni / static_cast<double>(texton.support_pixels), domain);
}

std::optional<KurtosisRange> local_kurtosis(const Model& model, const Domain& domain) {
  const SpotNoiseOptions* noise = spot_noise_of(model);
  if (noise == nullptr || noise->impacts != Impacts::stratified) return std::nullopt;
  const Texton& texton = *model.texton();
  KurtosisRange widest = {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const KurtosisRange& range : StratifiedMoments(texton).range_on(lattice_of(*noise, texton, domain))) {
    widest = {std::min(widest.least, range.least), std::max(widest.greatest, range.greatest)};
  }
  return widest;
}

/// Mean over the channels.
std::optional<double> spline_noise_kurtosis(const Model& model, const SplineNoiseOptions& noise) {
  if (noise.impacts == ImpactProcess::paper || noise.share) return std::nullopt;
  const SplineTexton& texton = *model.spline_texton();
  const bool stratified = noise.impacts == ImpactProcess::stratified;
  double sum = 0;
  for (const double channel : stratified ? stratified_spline_kurtosis(texton, noise.mni) : spline_kurtosis(texton)) {
    sum += stratified ? channel : channel / noise.mni;
  }
  return sum / texton.coefficients.channels();
}

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
  const SummedTexton summed = summed_texton(model);
  if (summed.texton == nullptr) return std::nullopt;
  return color_covariance(*summed.texton, summed.order).trace() / color_covariance(target.gaussian.spectrum).trace();
}

std::optional<double> rme_corrected(const Model& model, const Target& target, const Domain&) {
  const SummedTexton summed = summed_texton(model);
  if (summed.texton == nullptr) return std::nullopt;
  return correct_colors(*summed.texton, target.gaussian.spectrum, ColorCorrection::authors, summed.order).rme_after;
}

std::optional<double> rme_bound(const Model& model, const Target& target, const Domain&) {
  const SummedTexton summed = summed_texton(model);
  if (summed.texton == nullptr || summed.order > 0) return std::nullopt;
  return bound_texton_error(target.gaussian, support_mask(*summed.texton), {}, Seed{1}).rme;
}

std::optional<double> kernel_kurtosis(const Model& model, const Target&, const Domain&) {
  if (const SplineTexton* spline = model.spline_texton()) {
    const std::vector<double> channels = spline_kurtosis(*spline);
    return *std::ranges::max_element(channels);
  }
  if (model.texton() == nullptr) return std::nullopt;
  const std::vector<NoiseMoments> channels = poisson_moments(*model.texton(), 1);
  return std::ranges::max_element(channels, {}, &NoiseMoments::excess_kurtosis)->excess_kurtosis;
}

std::optional<double> predicted_kurtosis(const Model& model, const Target&, const Domain& domain) {
  if (const SplineNoiseOptions* splines = spline_noise_of(model)) return spline_noise_kurtosis(model, *splines);
  const SpotNoiseOptions* noise = spot_noise_of(model);
  if (noise == nullptr) return std::nullopt;
  if (noise->impacts == Impacts::gaussian) return 0;
  const Texton& texton = *model.texton();
  const std::vector<NoiseMoments> channels = noise->impacts == Impacts::poisson
                                                 ? poisson_moments(texton, noise->mni)
                                                 : StratifiedMoments(texton).on(lattice_of(*noise, texton, domain));
  double sum = 0;
  for (const NoiseMoments& channel : channels) sum += channel.excess_kurtosis;
  return sum / static_cast<double>(channels.size());
}

std::optional<double> local_kurtosis_least(const Model& model, const Target&, const Domain& domain) {
  const auto range = local_kurtosis(model, domain);
  return range ? std::optional(range->least) : std::nullopt;
}

std::optional<double> local_kurtosis_greatest(const Model& model, const Target&, const Domain& domain) {
  const auto range = local_kurtosis(model, domain);
  return range ? std::optional(range->greatest) : std::nullopt;
}

std::optional<double> poisson_impacts(const Model& model, const Target& target, const Domain& domain) {
  if (model.spline_texton() != nullptr) return *kernel_kurtosis(model, target, domain) / small_kurtosis;
  if (model.texton() == nullptr) return std::nullopt;
  return poisson_impacts_needed(*model.texton(), small_kurtosis);
}

std::optional<double> stratified_impacts(const Model& model, const Target&, const Domain&) {
  if (model.texton() == nullptr) return std::nullopt;
  return stratified_impacts_needed(*model.texton(), small_kurtosis);
}

}  // namespace textonbench
