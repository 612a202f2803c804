// Method "mixing": noise that moves from one texture to another along the way that optimal transport takes (Texton
// Noise, CGF 2017, Section 7).
//
// R textons are fitted to the barycenters (barycenter.h) of weights ρ_r = r / (R − 1), all from the same start, and an
// impact, of random sign, takes the texton of the weight nearest to that at its own place. So the law at a point is a
// mixture, by area, of those of the weights within the support around it, and nothing jumps where a strip ends.
#pragma once

#include "methods/method.h"

namespace textonbench {

MethodEntry mixing_entry();

}  // namespace textonbench
