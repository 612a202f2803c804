// Spots for synthesis at a size other than the exemplar's (Lectures 2022, "Synthesizing textures having arbitrary large
// size" and "Texton for synthesizing textures having arbitrary large size").
#pragma once

#include "methods/base/image.h"

namespace textonbench {

/// Equivalent spot on a raster of at least the spot's size: the spot p − mean in the center of a zero image, times a
/// window φ that rises from 0 to 1 as sin² over the outermost `border` pixels of the spot, times r such that Σ_x
/// |h(x)|² over all channels, the variance of its noise, is that of the spot. φ multiplies the spot, so the covariance
/// changes. border = 0: no window. Throws std::invalid_argument unless the raster holds the spot and 0 <= 2 border <=
/// each of its sides.
Image equivalent_spot(const Image& spot, Extent raster, int border);

/// Extended texton: the kernel in the center of a zero image. A concentrated kernel is small at its border and needs no
/// window; its noise has the aperiodic autocorrelation of the kernel as covariance, whatever the raster, once that is
/// at least twice its size.
Image extended_texton(const Image& kernel, Extent raster);

}  // namespace textonbench
