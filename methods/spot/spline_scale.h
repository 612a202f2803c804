// The numbers that turn a sum of kernels into a texton noise: start + scale Σ_i ε_i h_{k_i}(y − x_i).
#pragma once

#include <vector>

#include "methods/base/impact_grid.h"
#include "methods/base/texton.h"
#include "methods/spot/spline_noise.h"

namespace textonbench {

/// sqrt(K / λ); without K where kernels are chosen by place.
double spline_noise_scale(const SplineTexton& texton, const SplineNoiseOptions& options, const ImpactGrid& grid);

/// m less the mean of the scaled sum, for each channel.
std::vector<float> spline_noise_start(const SplineTexton& texton, double scale, const ImpactGrid& grid);

}  // namespace textonbench
