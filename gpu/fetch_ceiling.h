// How fast a renderer fetches texels when it does nothing else: what the fetches of a method are held against.
#pragma once

#include "methods/base/shader_recipe.h"

namespace textonbench {

/// Fetches of the first texture of `recipe`, as many as it needs a pixel (its useful_fetches, rounded, at least one),
/// filtered alike, and their mean as the value. Coherent: neighboring pixels read neighboring texels; otherwise each
/// fetch is at a random place. Throws std::invalid_argument for a recipe without a texture.
ShaderRecipe fetch_ceiling_recipe(const ShaderRecipe& recipe, bool coherent);

}  // namespace textonbench
