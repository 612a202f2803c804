// Second-order law of texton noise in closed form, Σ_k α̂_k α̂_k* b̂.
//
// b(j) = β^(2n+1)(j1) β^(2n+1)(j2) is the sampled autocorrelation of the B-spline of order n, and b̂(ξ) = b̂1(ξ1) b̂1(ξ2)
// its transform, in (0, 1] (CGF 2017, section 4.1).
#pragma once

#include <vector>

#include "methods/base/gaussian_model.h"
#include "methods/base/image.h"
#include "methods/base/texton.h"

namespace textonbench {

/// b̂^{1/2} at the frequencies (kx / W, ky / H) of a grid: what takes the spectrum of coefficients to that of their
/// noise. Exactly 1 at order 0.
class SplineGain {
 public:
  /// Throws std::invalid_argument for an order outside 0 … max_bspline_order.
  SplineGain(int order, Extent grid);

  /// The gain at (kx, ky) is column(kx) row(ky).
  double column(int kx) const { return columns_[static_cast<std::size_t>(kx)]; }
  double row(int ky) const { return rows_[static_cast<std::size_t>(ky)]; }

  /// α̂ b̂^{1/2}, for a spectrum on the grid.
  Spectrum apply(Spectrum coefficients) const;

 private:
  std::vector<double> columns_, rows_;
};

/// Cross-spectrum of the noise on Z² at the frequencies of a grid of any size, ξ = 0 included. It is that on every
/// shifted grid y + Z² as well: the noise is stationary under all translations of the plane. Throws
/// std::invalid_argument for an order outside 0 … max_bspline_order.
CrossSpectrum spline_spectrum(const SplineTexton& texton, Extent grid);

/// b * α inside the box of α, sums in double precision: Σ_x α(x) (b * α)(x) is the variance of the noise, ∫ h².
Image spline_overlap(const Image& coefficients, int order);

}  // namespace textonbench
