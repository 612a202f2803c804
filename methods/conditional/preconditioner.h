// Approximations of the inverse of a kriging operator, for the conjugate gradient method.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "methods/conditional/kriging.h"

namespace textonbench {

/// A symmetric and positive definite operator. Immutable: threads may share it.
class Preconditioner {
 public:
  virtual ~Preconditioner() = default;
  /// Both are as unknowns of the operator.
  virtual void apply(std::span<const double> residual, std::span<double> out) const = 0;
  virtual std::size_t bytes() const = 0;
};

struct SchwarzOptions {
  int cluster_pixels = 80;  ///< a cluster is cut in two until it has no more, before it is grown
  int overlap = 13;         ///< pixels by which each is grown on all sides, about a correlation length
  int most_pixels = 200;    ///< of a grown cluster: the nearest are taken
  /// Factors take at most about as many bytes; clusters are grown less where they would not fit.
  std::size_t most_bytes = std::size_t{600} << 20;
};

/// Overlapping additive Schwarz: M⁻¹ = Σ_i R_iᵀ (R_i Γ_CC R_iᵀ)⁻¹ R_i over clusters of conditioning pixels, each grown
/// by its neighborhood. The factors are kept in single precision. Throws std::invalid_argument, telling the nugget that
/// would help, when the covariance of a cluster is singular.
std::unique_ptr<Preconditioner> schwarz_preconditioner(const KrigingOperator& op, const SchwarzOptions& options = {});

/// The inverse of t̂ t̂* + ε I on the grid of the operator, restricted to the conditioning pixels; ε is `shift` times the
/// mean variance of the channels. Kept as a measured comparison.
std::unique_ptr<Preconditioner> circulant_preconditioner(const KrigingOperator& op, double shift = 1e-3);

/// "… a nugget of 0.0001 (nugget = 0.0001) makes it regular", for messages about singular systems.
std::string nugget_advice();

/// True when the factor's least squared pivot is no more than rounding of the largest variance.
bool singular_pivots(double least_pivot, double largest_variance, std::size_t unknowns);

}  // namespace textonbench
