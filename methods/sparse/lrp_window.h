// The window of local random-phase noise (Gilet et al., SIGGRAPH Asia 2014, section 3.6).
//
// A Kaiser–Bessel window of order 3 and parameter 3π on [−1.5, 1.5], in units of the lattice's spacing:
//
//   w(y) = b(3π sqrt(1 − (y / 1.5)²)) / b(3π),
//
// b = I_3, the modified Bessel function. What the paper prints for it has (m + 2)! where I_3 has (m + 3)!, and is cut
// after five terms, far from convergence at 3π. The paper's own constant, ∫ r w² dr = 0.1126, is that of I_3: 0.11259,
// against 0.1049 of the printed series and 0.1179 of its five terms.
//
// With t = 1 − (y / 1.5)² the window is t^{3/2} times a polynomial in t.
#pragma once

#include <array>
#include <string_view>

namespace textonbench {

/// bessel: I_3, converged. printed: the paper's series, five terms.
enum class LrpWindow { bessel, printed };

/// Coefficients p_m with w = t^{3/2} Σ p_m t^m, of absolute error below 3e-7 in floats.
constexpr int lrp_window_terms = 9;
const std::array<float, lrp_window_terms>& lrp_window_polynomial(LrpWindow window);

/// w(y) in double precision, by its series; zero beyond ±1.5.
double lrp_window(LrpWindow window, double y);

/// Numbers that the method takes from its window, by quadrature.
struct LrpWindowMoments {
  double radial_energy = 0;  ///< ∫ r w²(r) dr
  double energy_radius = 0;  ///< δ with 75 % of ∫ |ŵ|² within [−δ, δ], w as a function of one variable; 1 / spacing
};
const LrpWindowMoments& lrp_window_moments(LrpWindow window);

}  // namespace textonbench
