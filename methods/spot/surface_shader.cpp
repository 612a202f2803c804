#include "methods/spot/surface_shader.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "methods/spot/kernel_texture.h"

namespace textonbench {
namespace {

/// Impacts and cells in the box around the box of a point, at most: the longest diagonals of a cube, and a cell more.
double most_turns(const SurfaceSum& sum) {
  const double reach = std::numbers::sqrt3 * (sum.thickness() + 1);
  const double cells = std::pow(reach / sum.grid().side() + 2, 3);
  return cells + sum.intensity() * std::pow(reach + 2 * sum.grid().side(), 3);
}

}  // namespace

ShaderRecipe surface_noise_recipe(const SurfaceSum& sum, const ShaderRequest& request) {
  const SplineTexton& whole = sum.texton();
  require_shader_kernels(whole, request);
  if (!(request.near.cwiseAbs().maxCoeff() <= SurfaceSum::furthest_coordinate)) {
    throw std::invalid_argument(
        fmt::format("shader for surface noise near ({}, {}): expected a point within {} pixels "
                    "of the origin",
                    request.near.x(), request.near.y(), SurfaceSum::furthest_coordinate));
  }
  const bool is_part = request.channels > 0 && request.channels < whole.coefficients.channels();
  const SplineTexton texton = is_part ? first_channels(whole, request.channels) : whole;
  ShaderRecipe recipe;
  recipe.shader = "surface_noise";
  recipe.channels = texton.coefficients.channels();
  recipe.in_space = true;
  add_kernels_to(recipe, texton, sum.scale(), request);
  const SpaceGrid& grid = sum.grid();
  recipe.defines.emplace_back("PROCESS", std::to_string(shader_process(grid.process())));
  if (grid.process() != ImpactProcess::stratified) {
    recipe.defines.emplace_back("THRESHOLDS", std::to_string(grid.thresholds().size()));
    recipe.words.push_back({"thresholds", grid.thresholds()});
    if (grid.thresholds().empty()) {
      recipe.words.back().words.push_back(0);  // a buffer is never empty; the shader does not look
    }
  }
  const std::uint64_t key = SurfaceSum::key(request.seed);
  recipe.uniforms.emplace_back("key",
                               std::array{static_cast<std::uint32_t>(key), static_cast<std::uint32_t>(key >> 32U)});
  const double side = grid.side() * 1024;
  recipe.uniforms.emplace_back("side_coarse", static_cast<std::int32_t>(side));
  recipe.uniforms.emplace_back("side_fraction", static_cast<std::uint32_t>((side - std::floor(side)) * 0x1p32));
  recipe.uniforms.emplace_back("thickness", static_cast<float>(sum.thickness()));
  std::vector<float> start;
  start.reserve(static_cast<std::size_t>(recipe.channels));
  for (int c = 0; c < recipe.channels; ++c)
    start.push_back(static_cast<float>(sum.start()[static_cast<std::size_t>(c)]));
  recipe.uniforms.emplace_back("start", std::move(start));
  recipe.useful_fetches = sum.intensity() * sum.thickness() * texton.support_area * fetches_an_impact(texton, request);
  recipe.turns = most_turns(sum);
  return recipe;
}

}  // namespace textonbench
