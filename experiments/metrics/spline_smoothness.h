// How smooth texton noise is between the pixels (Galerne, Leclaire, Moisan, CGF 2017, Section 10). Covariances are
// those of spline_law.h. Nothing for models that sum no splines or those of more than one texton, or whose texton is
// zero in a channel.
#pragma once

#include <optional>

#include "experiments/metrics/metric.h"

namespace textonbench {

/// The s for which differences of order k + 2 grow as step^s where they meet a knot: the noise has s − 1 continuous
/// derivatives there, and jumps where s = 0. From the mean squares m of differences of steps 1/64 and 1/32 pixel on 32
/// horizontal lines of 8 pixels, in double precision, of noise of 5 impacts summed from its definition: away from knots
/// they vanish and meet one in proportion to the step, so m grows as step^(2s + 1).
std::optional<double> knot_exponent(const Model& model, const Target& target, const Domain& domain);

/// E |f(y + εu) − f(y)|² over the diagonal directions u over that along the axes, ε = 1/20 pixel.
std::optional<double> subpixel_anisotropy(const Model& model, const Target& target, const Domain& domain);

/// E |f(y + εu) − f(y)|² / (ε² Var f) with ε = 1/20 pixel, the mean of both axes, 1/pixel².
std::optional<double> subpixel_gradient(const Model& model, const Target& target, const Domain& domain);

/// Sum over the lags v = 0 … 15 on both axes of what the covariance at v + 1/2 is outside the range of its values at v
/// and v + 1, over the variance.
std::optional<double> covariance_overshoot(const Model& model, const Target& target, const Domain& domain);

}  // namespace textonbench
