// Spot noise on a graphics processor: the recipe of gpu/shaders/spot_noise.glsl, whose impacts are those of impacts.h.
#pragma once

#include "methods/base/shader_recipe.h"
#include "methods/spot/spot_noise.h"
#include "methods/spot/spot_sum.h"

namespace textonbench {

/// `kernels` are those of the texton, which has `mean`. Stratified impacts agree bit for bit. Numbers of Poisson
/// impacts are made by the processor's operations in float64, and agree bit for bit where divisions are rounded
/// correctly; where one is off by its last bit, one cell in some 10^13 may have another number.
///
/// Its base is a whole point, and frames show whole points alone (on_grid).
///
/// Throws std::invalid_argument for the Gaussian limit, Poisson impacts from dense_intensity on, which are drawn pixel
/// by pixel, a filter, a place beyond 2^40 pixels from the origin, cells of more than 2^18 pixels, and kernels of more
/// than 2^16 pixels a side.
ShaderRecipe spot_noise_recipe(const SpotKernels& kernels, const std::vector<double>& mean, std::int64_t support_pixels,
                               const SpotNoiseOptions& options, const ShaderRequest& request);

}  // namespace textonbench
