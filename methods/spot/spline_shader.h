// Texton noise on a graphics processor: the recipe of gpu/shaders/texton_noise.glsl, whose impacts are those of
// SplineNoise bit for bit.
#pragma once

#include "methods/base/shader_recipe.h"
#include "methods/base/texton.h"
#include "methods/spot/spline_noise.h"

namespace textonbench {

/// Kernels are scaled by sqrt(K/λ) (kernel_texture.h).
///
/// Manual fetches of a filter choose the level and the probes of it as KernelFilter does, and leave to the texture unit
/// what is between texels and levels; hardware fetches hand it the footprint.
///
/// Its base is a corner of the cell that holds request.near, and useful_fetches count one of a filter as one.
///
/// Throws std::invalid_argument, besides where make_spline_noise does, for more than 8 channels, hardware fetches of
/// orders 2, 4 and 5, a filter of another order than 1, a place beyond 2^40 pixels from the origin, cells of more than
/// 2^18 pixels, and kernels of more than 2^16 pixels or 2^13 cells a side.
ShaderRecipe spline_noise_recipe(const SplineTexton& texton, const SplineNoiseOptions& options,
                                 const ShaderRequest& request);

}  // namespace textonbench
