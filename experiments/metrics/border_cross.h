// What the jumps between opposite borders of an exemplar do, and what taking its periodic component p does about it.
#pragma once

#include <optional>

#include "experiments/metrics/metric.h"

namespace textonbench {

/// max |Δp − Δ'u| / max |Δ'u| over pixels and channels, Δ the five-point Laplacian of the torus and Δ' that of the
/// neighbors inside the image; the difference of the means of p and u counts too. 0 up to float32 rounding. Nothing for
/// a constant exemplar.
std::optional<double> periodic_laplacian_error(const Model& model, const Target& target, const Domain& domain);

/// Power of the model's law on the two axes of frequencies, from 8 cycles a side on, divided by the mean power 4 to 8
/// bins beside them. Above 1 where a cross stands in the spectrum. Nothing for exemplars below 32 x 32 and for models
/// without a law in closed form.
std::optional<double> axis_energy_ratio(const Model& model, const Target& target, const Domain& domain);

/// Mean over half-octave bands of both axes, from 4 cycles a side on, of |10 log₁₀(M / E)|, in dB: E the power that the
/// exemplar's periodogram under a Hann window has on the axis, which no border jump enters, and M its expectation under
/// the model's law,
///
///   M(k) = Σ_{|a|,|b| <= 1} w_a w_b tr P(k + (a, b)),   w_0 = 2/3, w_±1 = 1/6,
///
/// exactly, as a Hann window has three Fourier coefficients a side. Nothing as above.
std::optional<double> axis_power_error(const Model& model, const Target& target, const Domain& domain);

}  // namespace textonbench
