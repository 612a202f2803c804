// The canonical texton of an exemplar: its spot with all phases set to zero (Lectures 2022, Texton; Desolneux, Moisan,
// Ronsin 2012). It is defined for gray textures, so channels are averaged first. Whatever the model. Nothing for an
// exemplar whose average of channels does not vary.
#pragma once

#include <optional>

#include "experiments/metrics/metric.h"

namespace textonbench {

/// Energy of the canonical texton in the disc around its center that holds 1 % of the raster's area, as a part of the
/// whole. 0.01 for a texton of random phases.
std::optional<double> canonical_central_energy(const Model& model, const Target& target, const Domain& domain);

/// Largest |t(x)| off the center over t at the center: below 1, since t(0) is the mean of |t̂|.
std::optional<double> canonical_side_peak(const Model& model, const Target& target, const Domain& domain);

/// Relative model error of the canonical texton's circular Gaussian noise, for the gray texture as its target: 0.
std::optional<double> canonical_law_error(const Model& model, const Target& target, const Domain& domain);

/// Energy of an image in the disc of that part of its area around pixel (w/2, h/2), over its whole energy, first
/// channel.
double central_energy(const Image& image, double area_part);

}  // namespace textonbench
