// Statements on texton noise on a surface (Galerne, Leclaire, Moisan, CGF 2017, Section 6), at points with random
// frames. F is the raw noise Σ_i (1 − (2/r) |<d_i, n>|)₊ h(<d_i, u1>, <d_i, u2>), d_i = y − x_i, of λ Poisson impacts a
// unit of volume, r the side of h's support, and 60 of them reach a point. "Deviation" is largest_deviation
// (replicates.h): at most 1 but in 1 % of the cases when the statement holds. Nothing for models that sum no splines or
// those of more than one texton, or whose texton is zero in a channel or not square.
#pragma once

#include <optional>

#include "experiments/metrics/metric.h"

namespace textonbench {

/// Deviation of the mean of 8192 values of F, summed from the definition, from λ (r/2) ∫h (Proposition 3).
std::optional<double> surface_mean_deviation(const Model& model, const Target& target, const Domain& domain);

/// Deviation of the mean of (F − E F)² from λ (r/3) ∫h².
std::optional<double> surface_variance_deviation(const Model& model, const Target& target, const Domain& domain);

/// Mean number of impacts that reach a point over λ r³.
std::optional<double> surface_impacts_ratio(const Model& model, const Target& target, const Domain& domain);

/// Variance of normalized surface noise over that of the noise of the plane, all channels together, each from 16384
/// points too far apart to share an impact: samples of both methods.
std::optional<double> surface_variance_ratio(const Model& model, const Target& target, const Domain& domain);

}  // namespace textonbench
