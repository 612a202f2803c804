// The share of a mixture (plane_share.h) on a graphics processor: what gpu/shaders/share.glsl reads.
#pragma once

#include <span>

#include "methods/base/shader_recipe.h"
#include "methods/spot/plane_share.h"

namespace textonbench {

/// Adds the define SHARE and what the kernels of impacts need, `kernels` of the size `box`. The recipe has its base.
void add_share_to(ShaderRecipe& recipe, const PlaneShare& share, Extent box, int kernels);

/// Adds the mean (1 − ρ) first + ρ second at each point to a recipe that has a share, of its first channels.
void add_means_to(ShaderRecipe& recipe, std::span<const double> first, std::span<const double> second);

}  // namespace textonbench
