// Surface noise on a graphics processor: the recipe of gpu/shaders/surface_noise.glsl.
#pragma once

#include "methods/base/shader_recipe.h"
#include "methods/spot/surface_sum.h"

namespace textonbench {

/// Impacts are those of SurfaceSum, their places to 2^−20 pixel. The base is the origin of space.
///
/// Throws std::invalid_argument for more than 8 channels, hardware fetches of orders 2, 4 and 5, a filter of another
/// order than 1, and a place beyond SurfaceSum::furthest_coordinate.
ShaderRecipe surface_noise_recipe(const SurfaceSum& sum, const ShaderRequest& request);

}  // namespace textonbench
