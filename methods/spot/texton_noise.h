// Method "texton_noise": noise of a B-spline texton at random points of the plane (Galerne, Leclaire, Moisan, CGF
// 2017).
//
// Either one texton by the paper's alternating projections, or several of which each impact takes one, by direct
// minimization of the relative model error (optimal_texton.h), at the same cost a pixel.
//
// The division by b̂^{1/2}, down to 0.009 in the corner of the spectrum at order 5, has no floor: on photographs and a
// support of 30 x 30 the error of the noise stays within 0.006 of that of order 0 at all orders, and the corrected
// colors exact to 1e-7; the coefficients alone grow (by 8 at order 5).
#pragma once

#include <vector>

#include "methods/base/texton.h"
#include "methods/spot/optimal_texton.h"
#include "methods/spot/sot.h"
#include "methods/spot/spline_noise.h"

namespace textonbench {

enum class TextonFit { projections, direct };

struct TextonNoiseOptions {
  SpotSource component = SpotSource::periodic_component;
  int order = 1;  ///< of the B-splines, 0 to max_bspline_order
  TextonFit fit = TextonFit::projections;
  SotStart start = SotStart::random_phase;                   ///< of the projections
  ProjectionOptions projections{};                           ///< its order is not read
  OptimalTextonOptions direct{.kernels = 1};                 ///< its order is not read
  ColorCorrection color_correction = ColorCorrection::none;  ///< afterwards
};

/// Coefficients on S. At order 0 they are those of sot, or of optimal_texton, bit for bit. With a color correction the
/// covariance of the noise at one point is the exemplar's to 1e-6 of its norm. Throws std::invalid_argument for an
/// unusable exemplar, or as fit_sot, fit_optimal_texton and correct_colors do.
SplineTexton fit_texton_noise(const Exemplar& exemplar, const Support& support, const TextonNoiseOptions& options,
                              Seed seed);

/// The option "order".
ParamSpec spline_order_param();

/// The options of a fit, a reason why they do not go together, and the fit that they ask for.
std::vector<ParamSpec> texton_fit_params();
std::optional<std::string> refuse_texton_fit(const Problem& problem, const Params& params);
SplineTexton fit_texton_noise(const Exemplar& exemplar, const Params& params, Seed seed);

/// The options "impacts" (poisson|stratified|paper), "mni" and "cell" of a noise of splines, and their values.
std::vector<ParamSpec> spline_impacts_params();
SplineNoiseOptions spline_impacts_options(const Params& params);

/// The same and "route".
std::vector<ParamSpec> spline_noise_params();
SplineNoiseOptions spline_noise_options(const Params& params);

MethodEntry texton_noise_entry();

}  // namespace textonbench
