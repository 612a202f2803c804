// What methods that start from the exemplar's own spot share: taking it, and the domains that they serve.
#pragma once

#include <optional>
#include <string>

#include "methods/method.h"

namespace textonbench {

/// Which image the spot is taken from: the periodic component of the exemplar, or the exemplar as it is (whose border
/// jumps then show as a cross in the spectrum and as streaks in the samples).
enum class SpotSource { periodic_component, raw };

/// The option "component" and its value.
ParamSpec component_param();
SpotSource component_of(const Params& params);

/// Mean and normalised spot of the chosen image. Throws std::invalid_argument for an unusable exemplar.
GaussianModel fit_spot(const Exemplar& exemplar, SpotSource source);

/// A reason when `domain` is not the torus of the exemplar's own size with the pixel grid at the origin.
std::optional<std::string> refuse_other_torus(std::string_view method, Extent exemplar, const Domain& domain);

/// A reason when the domain's pixels are not points of Z².
std::optional<std::string> refuse_off_grid(std::string_view method, const Domain& domain);

/// Arithmetic per pixel of one inverse transform a channel and one product of spectra, random numbers apart.
double spectral_operations(int channels, Extent raster);

}  // namespace textonbench
