// Optimal textons: the best Gaussian approximation that a support allows, with a certificate.
//
// Each impact of a spot noise may pick one of K textons at no further cost a pixel; the cross-spectrum of the noise is
// then Σ_k ĥ_k ĥ_k*, no longer of rank one. The textons here minimize the relative model error (transport_objective.h)
// directly, by L-BFGS from white noise, and are mixed to equal energies and little kurtosis (texton_mix.h), so that
// the impacts needed are those of a single featureless texton. A certificate (certificate.h) tells how much any other
// textons of the same support could still gain.
//
// Our own step beyond EUSIPCO 2014, whose alternating projections are gradient descent of the same function for K = 1.
#pragma once

#include <string_view>
#include <vector>

#include "methods/base/gaussian_model.h"
#include "methods/base/random.h"
#include "methods/base/texton.h"
#include "methods/method.h"
#include "methods/spot/certificate.h"

namespace textonbench {

struct OptimalTextonOptions {
  int kernels = 4;        ///< K, at least 1
  int evaluations = 100;  ///< of the relative model error and its gradient, each K transforms a channel and back; as
                          ///< many again for the constraint of colors
  /// Asks for the exemplar's color covariance, Σ_k Σ_x h_k h_kᵀ = B, while minimizing: less error than mapping the
  /// colors of free textons afterwards. An augmented Lagrangian, whose small residual an exact linear map takes off.
  bool keep_color_covariance = false;
  /// Of the B-splines that the textons are coefficients of, 0 to max_bspline_order (spline_spectrum.h). The error is
  /// that of the noise, |α̂| b̂^{1/2} against |T|; mixing makes the energies of the coefficients equal.
  int order = 0;
};

struct OptimalTexton {
  Texton texton;
  double rme = 0;  ///< of the texton, colors kept or not
  /// r = (Σ_k Σ_x h_k ∂RME²/∂h_k) / 2: zero where no scaling of the textons gains.
  double stationarity = 0;
  int evaluations = 0;
  std::vector<double> history;  ///< lowest RME² after each evaluation; under the constraint of colors, that of each
  std::string_view reason;      ///< why the last minimization stopped (lbfgs.h)
};

/// Textons on the pixels of `mask` (one channel, not zero inside, at most as large as the exemplar) for a Gaussian
/// model of rank one. Throws std::invalid_argument for a mask that is empty or too large, for a model without variance
/// or not of rank one, and for options out of range.
OptimalTexton fit_optimal_texton(const GaussianModel& model, const Image& mask, const OptimalTextonOptions& options,
                                 Seed seed);

/// A lower bound on the RME of all sets of textons on the mask (certificate.h says what it assumes). It is proven by
/// textons of its own, more of them and closer to the minimum than a noise needs. Of order 0 only: the coefficients of
/// other orders have a norm of their own in (1) of certificate.h.
struct TextonBound {
  double rme = 0;       ///< no textons on the support have a lower RME, sqrt of certificate.bound
  double attained = 0;  ///< RME of the textons that prove it
  Certificate certificate;
};

struct TextonBoundOptions {
  OptimalTextonOptions proof{.kernels = 8, .evaluations = 200};
  CertificateOptions certificate;
};

/// Throws std::invalid_argument for an order other than 0, and as fit_optimal_texton and certify do.
TextonBound bound_texton_error(const GaussianModel& model, const Image& mask, const TextonBoundOptions& options,
                               Seed seed);

MethodEntry optimal_texton_entry();

}  // namespace textonbench
