// Overlapping additive Schwarz: M⁻¹ = Σ_i R_iᵀ (R_i Γ_CC R_iᵀ)⁻¹ R_i over clusters of conditioning pixels, each grown
// by its neighborhood.
#pragma once

#include <memory>

#include "methods/conditional/solver.h"

namespace textonbench {

struct SchwarzOptions {
  int cluster_pixels = 80;  ///< a cluster is cut in two until it has no more, before it is grown
  int overlap = 13;         ///< pixels by which each is grown, about a correlation length
};

/// Throws std::invalid_argument, telling the nugget that would help, when the covariance of a cluster is not positive
/// definite.
std::unique_ptr<Preconditioner> schwarz_preconditioner(const KrigingOperator& op, const SchwarzOptions& options = {});

/// Restriction of the inverse of (t̂ t̂* + ε I) on the grid of the operator: kept as a measured comparison.
std::unique_ptr<Preconditioner> circulant_preconditioner(const KrigingOperator& op, double shift = 1e-3);

}  // namespace textonbench
