// Squared relative model error of a set of textons, as a function of their pixels.
//
// For K kernels h_k on a support S and a target of rank one, T T* with T(0) = 0 (the normalised spot of an exemplar),
// the Gaussian optimal-transport distance has the closed form
//
//   RME² = (1/E) Σ_{ξ≠0} [ Σ_k |ĥ_k|² − 2 s + |T|² ],   s(ξ) = sqrt(Σ_k |T* ĥ_k|²),   E = Σ_{ξ≠0} |T|²,
//
// which for K = 1 is eq. 1 of EUSIPCO 2014. Its gradient is 2 |Ω| / E times the part on S of the inverse transform of
//
//   ĥ_k − T (T* ĥ_k) / s   for ξ ≠ 0, and 0 at ξ = 0.
//
// Where the kernels are the coefficients of B-splines (spline_spectrum.h) ĥ_k stands for α̂_k b̂^{1/2} and the gradient
// is multiplied by b̂^{1/2}. At order 0 a gradient step of E / (2 |Ω|) is one alternating projection of the SOT (up to
// ĥ_k(0), which does not count).
#pragma once

#include <span>
#include <vector>

#include "methods/base/fft.h"
#include "methods/spot/spline_spectrum.h"
#include "methods/spot/support_plane.h"

namespace textonbench {

class TransportObjective {
 public:
  /// `target`: T, whose value at ξ = 0 is not read. `order`: of the B-splines. Throws std::invalid_argument for a
  /// target that is zero elsewhere too, for a support that SupportPlane refuses and for an order out of range.
  explicit TransportObjective(Spectrum target, const Image& mask, int order = 0);

  const Spectrum& target() const { return target_; }
  const SupportPlane& support() const { return support_; }
  /// E / |Ω|, the variance of the target summed over channels.
  double variance() const { return variance_; }
  /// The step that makes one alternating projection of a gradient step, E / (2 |Ω|).
  double projection_step() const { return variance_ / 2; }

  /// RME² at K kernels, one function on the support after another, K = kernels.size() / support().size(), and its
  /// gradient. Transforms are float32, sums float64: the value is within 1e-7 and the gradient, relative to its terms,
  /// within 1e-6 of those of exact arithmetic.
  double evaluate(std::span<const double> kernels, std::span<double> gradient) const;

  /// s(ξ) on the half spectrum, row by row of T.columns() numbers; zero at ξ = 0.
  std::vector<double> overlap(std::span<const double> kernels) const;

  /// The kernels as images of the size of the support's box.
  std::vector<Image> images(std::span<const double> kernels) const;

 private:
  /// α̂_k.
  std::vector<Spectrum> transform(std::span<const double> kernels) const;

  Spectrum target_;
  SupportPlane support_;
  SplineGain gain_;
  double variance_;
};

}  // namespace textonbench
