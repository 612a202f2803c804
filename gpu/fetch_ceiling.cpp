#include "gpu/fetch_ceiling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace textonbench {

ShaderRecipe fetch_ceiling_recipe(const ShaderRecipe& recipe, bool coherent) {
  if (recipe.textures.empty()) {
    throw std::invalid_argument(fmt::format("recipe of {} without a texture: expected one to fetch", recipe.shader));
  }
  const ShaderTexture& texture = recipe.textures.front();
  const long fetches = std::max(1L, std::lround(recipe.useful_fetches));
  const auto number = [](auto value) { return fmt::format("{}", value); };
  return {.shader = "fetch_ceiling",
          .channels = recipe.channels,
          .base = recipe.base,
          .defines = {{"SAMPLER", texture.sampler},
                      {"TEXELS_X", number(texture.size.width)},
                      {"TEXELS_Y", number(texture.size.height)},
                      {"LAYERS", number(texture.layers)},
                      {"FETCHES", number(fetches)},
                      {"FILTERED", number(texture.filter == ShaderFilter::none ? 0 : 1)},
                      {"COHERENT", number(coherent ? 1 : 0)}},
          .uniforms = {},
          .textures = {texture},
          .words = {},
          .useful_fetches = static_cast<double>(fetches)};
}

}  // namespace textonbench
