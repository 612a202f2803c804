// Non-negative basis-pursuit denoising: a power as a sparse sum of powers of kernels (Galerne, Lagae, Lefebvre,
// Drettakis, SIGGRAPH 2012),
//
//   min over c >= 0 of ½ Σ_ξ m(ξ)² (p(ξ) − Σ_b,F c_b(F) G_b(ξ − F))² + λ Σ_b |G_b| Σ_F c_b(F),
//
// |G_b| the norm of an atom, by FISTA (Beck and Teboulle, SIAM J. Imaging Sciences 2, 2009) with adaptive restarts
// (O'Donoghue and Candès, Found. Comput. Math. 15, 2015), for a λ that falls from where c = 0 until the residual is at
// the level of noise: bins of a periodogram scatter by as much as their mean. Then c is
// freed of what the penalty took from it by multiplicative updates, which keep what is zero and the sum (Richardson, J.
// Opt. Soc. Am. 62, 1972; Lucy, Astron. J. 79, 1974).
#pragma once

#include <string_view>
#include <vector>

#include "methods/sparse/gabor_dictionary.h"

namespace textonbench {

/// What residuals are weighted by. power: not at all, as in the paper. transport: by 1 / sqrt(smoothed power), so that
/// half of their sum is twice the optimal-transport distance of the powers to second order.
enum class PursuitResidual { power, transport };

struct PursuitOptions {
  PursuitResidual residual = PursuitResidual::transport;
  /// Sum of squared residuals that is looked for, as a part of what the bins' scatter makes of it, above 0.
  double noise = 1;
  double scatter = 1;     ///< variance of a bin of the power as a part of its square: 1 of one periodogram
  int iterations = 1000;  ///< in all, for all λ
};

/// The minimum for λ = `penalty` times the least one with c = 0, to a relative change of the coefficients of
/// `tolerance`. `power` as in pursue(); options.noise is not looked at.
Image penalized_coefficients(const GaborDictionary& dictionary, const Image& power, const PursuitOptions& options,
                             double penalty, double tolerance);

struct Pursuit {
  Image coefficients;       ///< c_b(F), a channel a band, whole plane
  std::vector<double> rme;  ///< relative model error of the power after each iteration, and in the end
  double residual = 0;      ///< Σ m² (p − q)² as a part of what the bins' scatter makes of it
  std::string_view reason;  ///< "tolerance" once `noise` was reached, else "iterations" or "no descent"
};

/// p / q, where q is below a millionth of its greatest value p over that.
Image power_ratio(const Image& power, const Image& model);

/// p: whole plane, even, not negative; bin 0 is left out. Throws std::invalid_argument for a power that is not finite,
/// negative, zero everywhere or not even.
Pursuit pursue(const GaborDictionary& dictionary, const Image& power, const PursuitOptions& options);

}  // namespace textonbench
