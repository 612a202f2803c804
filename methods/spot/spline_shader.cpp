#include "methods/spot/spline_shader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "methods/spot/kernel_texture.h"
#include "methods/spot/share_shader.h"
#include "methods/spot/spline_scale.h"

namespace textonbench {
namespace {

constexpr double furthest_place = 0x1p40;
constexpr double greatest_cell = 0x1p18;
constexpr int greatest_kernel = 1 << 16;
constexpr double most_cells_aside = 0x1p13;

void require_shader_limits(const SplineTexton& texton, const ShaderRequest& request, const ImpactGrid& grid) {
  require_shader_kernels(texton, request);
  if (!(request.near.cwiseAbs().maxCoeff() <= furthest_place)) {
    throw std::invalid_argument(
        fmt::format("shader for texton noise near ({}, {}): expected a point within 2^40 pixels of the origin",
                    request.near.x(), request.near.y()));
  }
  const Extent box = texton.coefficients.extent();
  const int longer = std::max(box.width, box.height) + texton.order;
  if (!(grid.side() <= greatest_cell && longer <= greatest_kernel && longer <= most_cells_aside * grid.side())) {
    throw std::invalid_argument(fmt::format(
        "shader for texton noise with kernels of {}x{} coefficients and cells of {} pixels: expected kernels "
        "of at most 2^16 pixels and 2^13 cells a side, and cells of at most 2^18 pixels",
        box.width, box.height, grid.side()));
  }
}

std::uint32_t low_word(std::uint64_t v) { return static_cast<std::uint32_t>(v); }
std::uint32_t high_word(std::uint64_t v) { return static_cast<std::uint32_t>(v >> 32U); }

void add_impacts_to(ShaderRecipe& recipe, const ImpactGrid& grid, const ShaderRequest& request) {
  const auto cell_x = static_cast<std::int64_t>(std::floor(request.near.x() / grid.side()));
  const auto cell_y = static_cast<std::int64_t>(std::floor(request.near.y() / grid.side()));
  recipe.base = {static_cast<double>(cell_x) * grid.side(), static_cast<double>(cell_y) * grid.side()};
  const auto x = static_cast<std::uint64_t>(cell_x);
  const auto y = static_cast<std::uint64_t>(cell_y);
  const std::uint64_t key = spline_noise_key(request.seed);
  recipe.uniforms.emplace_back("base_cell", std::array{low_word(x), high_word(x), low_word(y), high_word(y)});
  recipe.uniforms.emplace_back("key", std::array{low_word(key), high_word(key)});
  recipe.uniforms.emplace_back("cell_side", static_cast<std::int32_t>(grid.coarse_side()));
  recipe.defines.emplace_back("PROCESS", std::to_string(shader_process(grid.process())));
  if (grid.process() == ImpactProcess::paper) {
    recipe.uniforms.emplace_back("cell_mean", static_cast<float>(grid.cell_mean()));
  } else if (grid.process() != ImpactProcess::stratified) {
    recipe.defines.emplace_back("THRESHOLDS", std::to_string(grid.thresholds().size()));
    recipe.words.push_back({"thresholds", grid.thresholds()});
    if (grid.thresholds().empty()) {
      recipe.words.back().words.push_back(0);  // a buffer is never empty; the shader does not look
    }
  }
}

}  // namespace

ShaderRecipe spline_noise_recipe(const SplineTexton& texton, const SplineNoiseOptions& options,
                                 const ShaderRequest& request) {
  if (request.channels > 0 && request.channels < texton.coefficients.channels()) {
    ShaderRequest of_part = request;
    of_part.channels = 0;
    return spline_noise_recipe(first_channels(texton, request.channels), options, of_part);
  }
  const ImpactGrid grid = spline_noise_impacts(texton, options);
  require_shader_limits(texton, request, grid);
  const double scale = spline_noise_scale(texton, options, grid);
  const Texton& coefficients = texton.coefficients;
  ShaderRecipe recipe;
  recipe.shader = "texton_noise";
  recipe.channels = coefficients.channels();
  add_impacts_to(recipe, grid, request);
  recipe.uniforms.emplace_back("start", spline_noise_start(texton, scale, grid));
  add_kernels_to(recipe, texton, scale, request);
  if (options.share) {
    add_share_to(recipe, *options.share, coefficients.extent(), static_cast<int>(coefficients.kernels.size()));
  }
  recipe.useful_fetches = grid.intensity() * texton.support_area * fetches_an_impact(texton, request);
  return recipe;
}

}  // namespace textonbench
