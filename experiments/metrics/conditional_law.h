// Statements on Gaussian conditional simulation. All are null for a model that is not inpainting.
#pragma once

#include <optional>

#include "experiments/metrics/metric.h"

namespace textonbench {

// Of a hole of 5 x 4 pixels in the first 16 x 16 of the exemplar, conditioned on a border of 2, over 2000 samples, held
// against dense algebra with covariances by the sum that defines them. A nugget of 1e-3 keeps crops of very smooth
// exemplars regular.

/// Mahalanobis distance of the mean of the samples from the conditional mean, as the standard normal number that a χ²
/// is nearly (Wilson and Hilferty 1931).
std::optional<double> conditional_mean_deviation(const Model& model, const Target& target, const Domain& domain);
/// The same of the sum of squared Mahalanobis distances of the samples under the conditional covariance.
std::optional<double> conditional_covariance_deviation(const Model& model, const Target& target, const Domain& domain);
/// Largest |correlation| of kriging component F* and innovation F − F* over pairs of values, times √2000.
std::optional<double> kriging_innovation_correlation(const Model& model, const Target& target, const Domain& domain);

// Of the model's own picture and hole.

/// Root mean square over the missing pixels of the difference between the kriging component and that with a border of
/// 20, over the standard deviation of the model.
std::optional<double> kriging_border_distance(const Model& model, const Target& target, const Domain& domain);
/// Mean conditional variance of some 50 missing pixels over that with a border of 10, by dense algebra; null above 5000
/// unknowns.
std::optional<double> kriging_variance_ratio(const Model& model, const Target& target, const Domain& domain);
/// Covariance between missing and known pixels at lags 8 <= |v|∞ <= 32, mean of 8 samples: root mean square difference
/// from that of the exemplar's own pixels, over that of samples which nothing is known of.
std::optional<double> hole_covariance_ratio(const Model& model, const Target& target, const Domain& domain);
/// sqrt(Σ ‖Γ − Γ'‖² / Σ ‖Γ‖²), |v|∞ <= 8, Γ estimated from the whole picture and Γ' without the missing pixels.
std::optional<double> estimate_bias(const Model& model, const Target& target, const Domain& domain);

}  // namespace textonbench
