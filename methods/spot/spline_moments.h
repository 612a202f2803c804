// How far a number of Poisson impacts leaves texton noise from its Gaussian limit (Campbell's theorem).
#pragma once

#include <vector>

#include "methods/base/texton.h"

namespace textonbench {

/// κ_c = A K Σ_k ∫ h_{k,c}⁴ / (Σ_k ∫ h_{k,c}²)², A being the support's area, for each channel: the excess kurtosis of
/// the noise at any point of the plane is κ_c / MNI. Integrals are exact but for rounding. 0 for a channel that is
/// zero.
std::vector<double> spline_kurtosis(const SplineTexton& texton);

}  // namespace textonbench
