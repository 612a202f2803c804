// How far a number of impacts leaves texton noise from its Gaussian limit, in closed form.
#pragma once

#include <vector>

#include "methods/base/texton.h"

namespace textonbench {

/// Poisson impacts (Campbell's theorem): κ_c = A K Σ_k ∫ h_{k,c}⁴ / (Σ_k ∫ h_{k,c}²)², A being the support's area, for
/// each channel: the excess kurtosis of the noise at any point of the plane is κ_c / MNI. Integrals are exact but for
/// rounding. 0 for a channel that is zero.
std::vector<double> spline_kurtosis(const SplineTexton& texton);

/// Stratified impacts, one in each cell of side a = (A / MNI)^{1/2}: excess kurtosis of each channel, averaged over the
/// places of a point in its cell,
///   a² [K Σ_k ∫ h_k⁴ − 3 ∫ s̄²] / (∫ s)²,   s = Σ_k h_k², s̄ the mean of s over the square of side a about a point,
/// since the fourth cumulant of a cell is E g⁴ − 3 (E g²)², g being the kernel at its random place. Exact but for
/// rounding; 0 for a channel that is zero.
std::vector<double> stratified_spline_kurtosis(const SplineTexton& texton, double mni);

}  // namespace textonbench
