// Method "surface_noise": texton noise on a surface in space, CGF 2017, Section 6 (surface_sum.h).
//
// On the plane z = 0 it has the law of texton noise; a sphere, a torus or a mesh is drawn in orthographic projection,
// its noise shaded by the angle to the line of sight, on white.
#pragma once

#include "methods/method.h"

namespace textonbench {

MethodEntry surface_noise_entry();

}  // namespace textonbench
