// How far the law of a texton's noise is from that of an exemplar.
#pragma once

#include "methods/base/gaussian_model.h"
#include "methods/base/texton.h"

namespace textonbench {

/// Cross-spectrum Σ_k ĥ_k ĥ_k* of the texton on a torus that holds it. Throws std::invalid_argument when it does not.
CrossSpectrum texton_spectrum(const Texton& texton, Extent torus);

/// Relative model error on the target's torus; of noise on Z², and on every shifted grid, where the kernels are the
/// coefficients of B-splines of an order above 0 (spline_spectrum.h).
double relative_model_error(const Texton& texton, const CrossSpectrum& target, int order = 0);

}  // namespace textonbench
