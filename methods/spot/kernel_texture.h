// Kernels of splines as a texture: what gpu/shaders/spline_kernel.glsl reads.
#pragma once

#include "methods/base/impact_grid.h"
#include "methods/base/shader_recipe.h"
#include "methods/base/texton.h"

namespace textonbench {

/// Throws std::invalid_argument for more than 8 channels, hardware fetches of orders 2, 4 and 5, and a filter of
/// another order than 1.
void require_shader_kernels(const SplineTexton& texton, const ShaderRequest& request);

/// Adds the texture "texton", the coefficients times `scale`, kernel by kernel and four channels a layer, and the
/// defines of spline_kernel.glsl. With a filter they are padded with zeros to a square whose side is a power of two,
/// and the mip levels are their averages over squares of 2^l from the first coefficient on: those of MipChain
/// (texton_filter.h). There are gradients of order 1 and more without a filter.
void add_kernels_to(ShaderRecipe& recipe, const SplineTexton& texton, double scale, const ShaderRequest& request);

/// Fetches of an impact that reaches a point; one of a filter counts as one.
int fetches_an_impact(const SplineTexton& texton, const ShaderRequest& request);

/// The first channels of all kernels.
SplineTexton first_channels(const SplineTexton& texton, int count);

/// PROCESS of gpu/shaders/impact_grid.glsl.
int shader_process(ImpactProcess process);

}  // namespace textonbench
