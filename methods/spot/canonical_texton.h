// Method "canonical_texton": noise of the texton of zero phase of a gray exemplar.
#pragma once

#include "methods/exemplar_spot.h"
#include "methods/spot/support.h"

namespace textonbench {

/// Zero-phase texton (see zero_phase_texton.h) of a gray exemplar, zero outside the support. Throws
/// std::invalid_argument, naming the exemplar, when it is unusable or has color.
Texton canonical_texton(const Exemplar& exemplar, SpotSource component, const Support& support);

MethodEntry canonical_texton_entry();

}  // namespace textonbench
