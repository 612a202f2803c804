// Method "luminance_texton": noise of the texton whose luminance has zero phase.
#pragma once

#include <array>

#include "methods/exemplar_spot.h"
#include "methods/spot/support.h"

namespace textonbench {

/// Weights of the channels in the luminance; EUSIPCO 2014, section 4.
struct LuminanceWeights {
  double red = 1.0 / 3;
  double green = 1.0 / 2;
  double blue = 1.0 / 6;
};

/// Texton whose luminance has zero phase (see zero_phase_texton.h), zero outside the support; of a gray exemplar, the
/// canonical texton, whatever the weights. Throws std::invalid_argument for an unusable exemplar, or weights that are
/// not finite or all zero.
Texton luminance_texton(const Exemplar& exemplar, SpotSource component, const LuminanceWeights& weights,
                        const Support& support);

MethodEntry luminance_texton_entry();

}  // namespace textonbench
