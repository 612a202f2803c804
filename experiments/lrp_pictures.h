// Pictures of what local random-phase noise is made of.
#pragma once

#include <span>

#include "experiments/pictures.h"

namespace textonbench {

/// lrp_power, lrp_strata, lrp_eroded, lrp_parts, lrp_windows, lrp_layer_1 to lrp_layer_4, lrp_variance, lrp_structure,
/// lrp_reduced, lrp_residual (metrics/lrp_diagrams.h).
std::span<const PictureEntry> lrp_pictures();

}  // namespace textonbench
