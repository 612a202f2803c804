// The way between two Gaussian textures that optimal transport takes (Xia, Ferradans, Peyré, Aujol, SIIMS 2014; Texton
// Noise, CGF 2017, Section 7).
//
// With the spots t_0 and t_1, spectra of one vector a frequency, the Gaussian law of rank one with the spot
//
//   τ_ρ(ξ) = (1 − ρ) s(ξ) t_0(ξ) + ρ t_1(ξ),   s = t_0* t_1 / |t_0* t_1|   (1 where t_0* t_1 = 0),
//
// is the barycenter with the weights 1 − ρ and ρ: at the distance ρ d from the first and (1 − ρ) d from the second,
// where d is their own. One phase a frequency is common to all channels, and the law of t_0 does not know of it.
#pragma once

#include "methods/base/gaussian_model.h"

namespace textonbench {

/// τ_ρ, and the mean between their means. Throws std::invalid_argument for models of different sizes or channels or not
/// of rank one, and for ρ outside [0, 1].
GaussianModel barycenter(const GaussianModel& first, const GaussianModel& second, double rho);

}  // namespace textonbench
