// Local random-phase noise on a graphics processor: the recipe of gpu/shaders/local_random_phase.glsl, whose waves are
// those of WaveLattice bit for bit.
#pragma once

#include <span>

#include "methods/base/shader_recipe.h"
#include "methods/sparse/fixed_phases.h"
#include "methods/sparse/wave_field.h"

namespace textonbench {

/// The buffer "tables" holds 16 words a layer (the shader's WaveLayer), then the places of each wave's bins and the
/// bins with their thresholds and colors. The base is the whole pixel nearest to request.near, and useful_fetches are
/// the words that a point reads.
///
/// `fixed` is null where there is no structure. Throws std::invalid_argument for a filter or texels of 16 bits, which
/// there are none of, more than 8 channels, a torus of more than 1024 pixels, windows wider than 2^18 pixels and a
/// place beyond 2^40 pixels from the origin.
ShaderRecipe wave_recipe(const WaveField& field, const FixedPhases* fixed, std::span<const double> mean,
                         const ShaderRequest& request);

}  // namespace textonbench
