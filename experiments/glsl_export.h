// Texton noise for other people's engines: one function of GLSL 3.30 and its texture.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "methods/base/image.h"
#include "methods/base/shader_recipe.h"

namespace textonbench {

struct GlslExport {
  std::string function;  ///< texton_noise.glsl: needs no uniform but the sampler that it is handed
  std::string example;   ///< a fragment shader of OpenGL 3.3 that draws gl_FragCoord, with the function
  /// Kernels below each other, within frames of zeros, scaled for the sum: one channel or three.
  Image texels;
  Image codes;  ///< the same as numbers n / 65535, texel = scale * code + offset
  double scale = 1, offset = 0;
  double png_error = 0;  ///< root mean square error of the noise by those codes' rounding, in the values' unit
  int fetches_an_impact = 1;
  double fetches = 0;  ///< mean number a point
  double cell = 0;     ///< side, pixels
  double cells = 0;    ///< most that a point visits
  std::uint64_t key = 0;
  int order = 1, kernels = 1;
};

/// From the recipe of texton noise around the origin, with manual fetches. Throws std::invalid_argument for another
/// recipe, orders other than 0, 1 and 3, more than three channels, the paper's impacts and kernels chosen by place.
GlslExport make_glsl_export(const ShaderRecipe& recipe);

/// Of README.md: what the noise is of, and how it was made.
struct GlslOrigin {
  std::string exemplar, sha256, licence, command;
};
std::string glsl_readme(const GlslExport& made, const GlslOrigin& origin);

/// Writes texton_noise.glsl, example.frag, texton.exr, texton.png, preview.png and README.md to a new folder, which
/// appears complete or not at all. Returns the files. Throws std::invalid_argument for a folder that exists, and
/// std::runtime_error naming what cannot be written.
std::vector<std::filesystem::path> write_glsl_export(const GlslExport& made, const Image& preview,
                                                     const std::string& readme, const std::filesystem::path& folder);

}  // namespace textonbench
