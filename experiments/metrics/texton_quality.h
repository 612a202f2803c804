// What a texton keeps of its exemplar, and how many impacts a noise needs to look Gaussian. All in closed form; nothing
// for models that sum no texton.
#pragma once

#include <optional>

#include "experiments/metrics/metric.h"

namespace textonbench {

/// 1 where a kernel is not zero in some channel, else 0.
Image support_mask(const Texton& texton);

/// Variance of the model over that of the target, all channels together. At the alternating projections' fixed points
/// 1 − RME².
std::optional<double> kept_variance(const Model& model, const Target& target, const Domain& domain);

/// RME once the colors are mapped by B^{1/2} A^{−1/2}, the papers' correction (methods/spot/color_correction.h).
std::optional<double> rme_corrected(const Model& model, const Target& target, const Domain& domain);

/// A proven lower bound on the RME of any textons of the same support (methods/spot/certificate.h).
std::optional<double> rme_bound(const Model& model, const Target& target, const Domain& domain);

/// κ = |S| K Σ h⁴ / (Σ h²)², the largest over channels: the excess kurtosis of Poisson impacts is κ / MNI.
std::optional<double> kernel_kurtosis(const Model& model, const Target& target, const Domain& domain);

/// The least MNI from which on |excess kurtosis| < 0.1 in every channel (methods/spot/kernel_moments.h).
std::optional<double> poisson_impacts(const Model& model, const Target& target, const Domain& domain);
std::optional<double> stratified_impacts(const Model& model, const Target& target, const Domain& domain);

}  // namespace textonbench
