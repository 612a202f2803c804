// Second-order law of Gabor noise in closed form, truncation included.
#pragma once

#include <vector>

#include "methods/base/gaussian_model.h"
#include "methods/sparse/gabor_field.h"

namespace textonbench {

/// ρ(v) = ∫ g(y) g(y + v) dy of a window that is cut, v in pixels: zero from twice the window on. Within 1e-5 of ρ(0).
class GaborCorrelation {
 public:
  explicit GaborCorrelation(const GaborWindow& window);
  double at(double x, double y) const;

 private:
  GaborWindow window_;
  double furthest_;            // root of the form at the last node
  std::vector<double> nodes_;  // ρ at equal steps of that root
};

/// Covariance matrix of the noise at a point.
Eigen::MatrixXd gabor_covariance(const GaborField& field);

/// Cross-spectrum on a grid of the noise's covariance, that of a band being
///
///   Γ_cd(v) = λ E w² ρ(v) Σ_e p_e ½ [Re(c_c c_d* exp(2πi f_e · v)) ± Re(c_c c_d) κ_e / ρ(0)],
///
/// p_e the chance of entry e and κ_e gabor_imbalance(): + for cosine phases, − for sine phases, and nothing for random
/// ones. Of a fixed phase the second term is that of windows that are not cut. Lags are taken modulo the grid: exact
/// where it is at least twice as large as the windows.
CrossSpectrum gabor_spectrum(const GaborField& field, Extent grid);

}  // namespace textonbench
