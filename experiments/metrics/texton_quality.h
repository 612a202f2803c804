// What a texton keeps of its exemplar, and how many impacts a noise needs to look Gaussian. All in closed form; nothing
// for models that sum no texton. Of a noise of B-splines (methods/spot/texton_noise.h) kernels are the functions of the
// plane, and errors and variances those of the noise on Z².
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

/// A proven lower bound on the RME of any textons of the same support (methods/spot/certificate.h). Nothing for
/// B-splines of an order above 0, for which no bound is known.
std::optional<double> rme_bound(const Model& model, const Target& target, const Domain& domain);

/// κ = |S| K Σ h⁴ / (Σ h²)², with integrals for B-splines (methods/spot/spline_moments.h), the largest over channels:
/// the excess kurtosis of Poisson impacts is κ / MNI.
std::optional<double> kernel_kurtosis(const Model& model, const Target& target, const Domain& domain);

/// Excess kurtosis of the model's own impacts, the mean over channels: what `excess_kurtosis` estimates.
std::optional<double> predicted_kurtosis(const Model& model, const Target& target, const Domain& domain);

/// Of stratified impacts, whose fourth order follows their cells: the least and the greatest local excess kurtosis,
/// over channels and over pixels of three cells. Nothing for other impacts, which are stationary.
std::optional<double> local_kurtosis_least(const Model& model, const Target& target, const Domain& domain);
std::optional<double> local_kurtosis_greatest(const Model& model, const Target& target, const Domain& domain);

/// The least MNI from which on |excess kurtosis| < 0.1 in every channel (methods/spot/kernel_moments.h).
std::optional<double> poisson_impacts(const Model& model, const Target& target, const Domain& domain);
/// The same for stratified impacts; nothing for B-splines, of which no closed form is at hand.
std::optional<double> stratified_impacts(const Model& model, const Target& target, const Domain& domain);

}  // namespace textonbench
