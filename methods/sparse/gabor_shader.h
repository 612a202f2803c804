// Gabor noise on a graphics processor: the recipe of gpu/shaders/gabor.glsl, whose kernels are those of GaborImpacts
// bit for bit.
#pragma once

#include <span>

#include "methods/base/shader_recipe.h"
#include "methods/sparse/gabor_field.h"

namespace textonbench {

/// The buffer "tables" holds 22 words a band (the shader's GaborBand), then thresholds and aliases, frequencies and
/// colors; the buffer "thresholds" those of the Poisson numbers of all bands. The base is the whole pixel nearest to
/// request.near, and useful_fetches are the words of the kernels that reach a point.
///
/// With the anisotropic filter a pixel of footprint F, whose sides are its columns, sees the kernels of
/// filtered_gabor() with the covariance F F^T / 12, that of a uniform density on it. There a band is left out that
/// keeps less than 1e-4 of its variance: bands that are drawn take at most 10^4 times as many impacts as unfiltered.
///
/// Throws std::invalid_argument for another filter or texels of 16 bits, which there are none of; the window of
/// unfiltered kernels; the impacts of another paper; more than 8 channels; frequencies beyond a cycle a pixel; cells of
/// more than 2^18 pixels; and a place beyond 2^40 pixels from the origin.
ShaderRecipe gabor_recipe(const GaborField& field, std::span<const double> mean, const ShaderRequest& request);

}  // namespace textonbench
