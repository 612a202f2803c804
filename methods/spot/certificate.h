// What no set of textons of a support can beat.
//
// For any kernels h_k on S, any function s(ξ) > 0 where T(ξ) ≠ 0, and any λ with
//
//   Σ_{ξ≠0} |T* ĝ|² / s  ≤  λ Σ_{ξ≠0} |ĝ|²   for all g on S,                                                  (1)
//
// the inequality of Cauchy and Schwarz gives, with A = Σ_k Σ_{ξ≠0} |ĥ_k|²,
//
//   Σ sqrt(Σ_k |T* ĥ_k|²)  ≤  sqrt(Σ s) sqrt(Σ Σ_k |T* ĥ_k|² / s)  ≤  sqrt(λ A Σ s),
//   E RME²  ≥  A − 2 sqrt(λ A Σ s) + E  ≥  E − λ Σ s.                                                          (2)
//
// So every s proves a bound, RME² ≥ 1 − λ Σ s / E, for one texton or many and however they were found. RME² is convex
// in the cross-spectrum Σ_k ĥ_k ĥ_k*, and at its minimum over all sets of textons the overlap s = sqrt(Σ_k |T* ĥ_k|²)
// of the minimizer gives equality: a set of textons near that minimum certifies itself.
//
// The least λ of (1) is the largest eigenvalue of a positive semidefinite operator, a convolution between pixels of S.
// Lanczos' method approaches it from below, with a known probability of being close (Kuczyński and Woźniakowski, SIAM
// J. Matrix Anal. 13, 1992, theorem 4.2): from a start that is uniform on the sphere of R^n, the largest Ritz value θ
// of m steps satisfies
//
//   Prob(θ < (1 − ε) λ)  ≤  1.648 sqrt(n) exp(−sqrt(ε) (2 m − 1)).
//
// ε is chosen so that this probability is `failure_probability`, and λ = θ / (1 − ε) + rounding is used. So what the
// bound assumes is that the pseudo-random start is as good as a random one, and that float32 transforms move θ by less
// than 1e-5 of λ. Their errors are in proportion to the largest |T|² / s, which a floor of s keeps small: the overlap
// is raised to |T|² / 32 where it is lower, which (2) allows. Against dense float64 solves θ is within 2e-6.
#pragma once

#include <span>

#include "methods/base/random.h"
#include "methods/spot/transport_objective.h"

namespace textonbench {

/// Least s / |T|².
inline constexpr double overlap_floor = 1.0 / 32;

struct CertificateOptions {
  int steps = 1500;                   ///< of Lanczos' method
  double failure_probability = 1e-9;  ///< that the bound is none
};

struct Certificate {
  double bound = 0;   ///< RME² of no set of textons on the support is lower
  double ritz = 0;    ///< θ
  double lambda = 0;  ///< upper bound on the largest eigenvalue; μ = 1 − λ in the scaling of the kernels
  int steps = 0;      ///< of Lanczos' method
};

/// The bound that the overlap of these kernels (laid out as for TransportObjective::evaluate) proves. Throws
/// std::invalid_argument for fewer than 1 step and for a probability outside (0, 1).
Certificate certify(const TransportObjective& objective, std::span<const double> kernels,
                    const CertificateOptions& options, Seed seed);

}  // namespace textonbench
