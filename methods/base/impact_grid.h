// Random impacts of the plane, drawn cell by cell, that CPU and GPU share bit for bit: integer hashes and fixed-point
// positions only.
#pragma once

#include <cstdint>
#include <vector>

#include "methods/base/random.h"

namespace textonbench {

/// poisson: an exact Poisson number of impacts a cell, of weight 1. stratified: one impact a cell, of weight ±1 with
/// equal probability. paper: the shader of Texton Noise (CGF 2017) with its defects, for the claims about it.
enum class ImpactProcess { poisson, stratified, paper };

}  // namespace textonbench
