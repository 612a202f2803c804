// Textons that concentrate a texture's law around one pixel by taking phases off its normalised spot (Desolneux,
// Moisan, Ronsin 2012).
#pragma once

#include <span>

#include "methods/base/gaussian_model.h"
#include "methods/base/texton.h"
#include "methods/spot/support.h"

namespace textonbench {

/// The spot T of the model with one phase a frequency taken off all channels, T conj(L) / |L| with L = Σ_c weights[c]
/// T_c, moved so that its center lies at pixel (w/2, h/2) of S' box, and zero outside S. On the whole torus its noise
/// has exactly the law of the model. Where L is nothing but rounding, |L|² below 1e-12 Σ_c |weights[c] T_c|², or zero,
/// T stays as it is: any phase gives the same law. With one channel L = T up to a factor, and the texton is even with
/// its largest value at the center: the canonical texton. Throws std::invalid_argument unless the model has one factor
/// and as many channels as weights, the weights are finite and not all zero, and S fits into the torus.
Texton zero_phase_texton(const GaussianModel& model, std::span<const double> weights, const Support& support);

}  // namespace textonbench
