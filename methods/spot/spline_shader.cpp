#include "methods/spot/spline_shader.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <string>

#include "methods/spot/spline_scale.h"

namespace textonbench {
namespace {

constexpr int most_channels = 8;
constexpr int group_channels = 4;  // of a layer
constexpr double furthest_place = 0x1p40;
constexpr double greatest_cell = 0x1p18;
constexpr int greatest_kernel = 1 << 16;
constexpr double most_cells_aside = 0x1p13;

bool is_filtered(const ShaderRequest& request) { return request.filter != ShaderFilter::none; }

void require_fetches(int order, const ShaderRequest& request) {
  if (is_filtered(request) && order != 1) {
    throw std::invalid_argument(fmt::format(
        "filtered fetches of texton noise of order {}: mip levels are of bilinear kernels, expected order 1", order));
  }
  if (request.fetch == ShaderFetch::hardware && order != 0 && order != 1 && order != 3) {
    throw std::invalid_argument(fmt::format(
        "hardware fetches of texton noise of order {}: a texture unit's bilinear fetches make orders 0, 1 and 3; take "
        "manual fetches",
        order));
  }
}

SplineTexton first_channels(const SplineTexton& texton, int count) {
  SplineTexton part = texton;
  for (std::size_t k = 0; k < part.coefficients.kernels.size(); ++k) {
    const Image& kernel = texton.coefficients.kernels[k];
    Image& kept = part.coefficients.kernels[k];
    kept = Image(kernel.extent(), count);
    for (int c = 0; c < count; ++c) {
      for (int y = 0; y < kernel.height(); ++y) std::ranges::copy(kernel.row(c, y), kept.row(c, y).begin());
    }
  }
  part.coefficients.mean.resize(static_cast<std::size_t>(count));
  return part;
}

void require_shader_limits(const SplineTexton& texton, const SplineNoiseOptions& options, const ShaderRequest& request,
                           const ImpactGrid& grid) {
  if (options.kernel_at) {
    throw std::invalid_argument(
        "kernels of texton noise chosen by place: a shader draws them by chance, and has no function of the place");
  }
  if (texton.coefficients.channels() > most_channels) {
    throw std::invalid_argument(fmt::format("shader for texton noise of {} channels: expected at most {}",
                                            texton.coefficients.channels(), most_channels));
  }
  require_fetches(texton.order, request);
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

/// Where the texels of the levels are.
struct TextonLayout {
  Extent size;
  int groups = 1;
  int components = 1;
  int layers = 1;
};

TextonLayout layout_of(const Texton& coefficients, bool filtered) {
  TextonLayout layout;
  layout.size = coefficients.extent();
  if (filtered) {
    const auto longer = static_cast<unsigned>(std::max(layout.size.width, layout.size.height));
    const int side = static_cast<int>(std::bit_ceil(longer));
    layout.size = {side, side};
  }
  const int channels = coefficients.channels();
  layout.groups = (channels + group_channels - 1) / group_channels;
  // Drivers pad three components to four.
  layout.components = channels < 3 ? channels : group_channels;
  layout.layers = static_cast<int>(coefficients.kernels.size()) * layout.groups;
  return layout;
}

std::size_t texel_index(const TextonLayout& layout, int layer, int x, int y) {
  const auto row =
      static_cast<std::size_t>(layer) * static_cast<std::size_t>(layout.size.height) + static_cast<std::size_t>(y);
  return (row * static_cast<std::size_t>(layout.size.width) + static_cast<std::size_t>(x)) *
         static_cast<std::size_t>(layout.components);
}

std::vector<float> finest_level(const Texton& coefficients, double scale, const TextonLayout& layout) {
  std::vector<float> texels(texel_index(layout, layout.layers, 0, 0));
  for (std::size_t k = 0; k < coefficients.kernels.size(); ++k) {
    const Image& kernel = coefficients.kernels[k];
    for (int c = 0; c < kernel.channels(); ++c) {
      const int layer = static_cast<int>(k) * layout.groups + c / group_channels;
      for (int y = 0; y < kernel.height(); ++y) {
        float* to = texels.data() + texel_index(layout, layer, 0, y) + c % group_channels;
        for (const float v : kernel.row(c, y)) {
          *to = static_cast<float>(scale * v);
          to += layout.components;
        }
      }
    }
  }
  return texels;
}

/// Averages over squares of four texels.
std::vector<float> coarser_level(const std::vector<float>& texels, const TextonLayout& fine,
                                 const TextonLayout& coarse) {
  std::vector<float> averages;
  averages.reserve(texel_index(coarse, coarse.layers, 0, 0));
  for (int layer = 0; layer < coarse.layers; ++layer) {
    for (int y = 0; y < coarse.size.height; ++y) {
      for (int x = 0; x < coarse.size.width; ++x) {
        const std::size_t upper = texel_index(fine, layer, 2 * x, 2 * y);
        const std::size_t lower = texel_index(fine, layer, 2 * x, 2 * y + 1);
        const auto next = static_cast<std::size_t>(fine.components);
        for (std::size_t c = 0; c < next; ++c) {
          averages.push_back(
              0.25F * (texels[upper + c] + texels[upper + next + c] + texels[lower + c] + texels[lower + next + c]));
        }
      }
    }
  }
  return averages;
}

ShaderTexture texton_texture(const Texton& coefficients, double scale, const ShaderRequest& request) {
  TextonLayout layout = layout_of(coefficients, is_filtered(request));
  ShaderTexture texture;
  texture.sampler = "texton";
  texture.size = layout.size;
  texture.layers = layout.layers;
  texture.components = layout.components;
  texture.half_float = request.half_float;
  texture.linear = request.fetch == ShaderFetch::hardware || is_filtered(request);
  // Probes of the shader's own choice are trilinear ones.
  const bool own_probes = request.fetch == ShaderFetch::manual && request.filter == ShaderFilter::anisotropic;
  texture.filter = own_probes ? ShaderFilter::trilinear : request.filter;
  texture.levels.push_back(finest_level(coefficients, scale, layout));
  while (is_filtered(request) && layout.size.width > 1) {
    TextonLayout coarse = layout;
    coarse.size = {layout.size.width / 2, layout.size.height / 2};
    texture.levels.push_back(coarser_level(texture.levels.back(), layout, coarse));
    layout = coarse;
  }
  return texture;
}

/// The number of impact_grid.glsl.
int process_number(ImpactProcess process) {
  switch (process) {
    case ImpactProcess::poisson:
      return 0;
    case ImpactProcess::signed_poisson:
      return 1;
    case ImpactProcess::stratified:
      return 2;
    case ImpactProcess::paper:
      break;
  }
  return 3;
}

/// Number of the filter in spline_kernel.glsl.
int filter_number(ShaderFilter filter) {
  switch (filter) {
    case ShaderFilter::none:
      return 0;
    case ShaderFilter::mipmap:
      return 1;
    case ShaderFilter::trilinear:
      return 2;
    case ShaderFilter::anisotropic:
      break;
  }
  return 3;
}

std::uint32_t low_word(std::uint64_t v) { return static_cast<std::uint32_t>(v); }
std::uint32_t high_word(std::uint64_t v) { return static_cast<std::uint32_t>(v >> 32U); }

/// Fetches of one impact.
int fetches_of(int order, const ShaderRequest& request) {
  if (request.fetch == ShaderFetch::manual && !is_filtered(request)) {
    return (order + 1) * (order + 1);
  }
  return order == 3 ? 4 : 1;
}

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
  recipe.defines.emplace_back("PROCESS", std::to_string(process_number(grid.process())));
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
  require_shader_limits(texton, options, request, grid);
  const double scale = spline_noise_scale(texton, options, grid);
  const Texton& coefficients = texton.coefficients;
  ShaderRecipe recipe;
  recipe.shader = "texton_noise";
  recipe.channels = coefficients.channels();
  add_impacts_to(recipe, grid, request);
  recipe.uniforms.emplace_back("start", spline_noise_start(texton, scale, grid));
  recipe.textures.push_back(texton_texture(coefficients, scale, request));
  const auto define = [&](const char* name, std::int64_t value) {
    recipe.defines.emplace_back(name, std::to_string(value));
  };
  define("ORDER", texton.order);
  define("MANUAL_FETCH", request.fetch == ShaderFetch::manual ? 1 : 0);
  define("FILTER", filter_number(request.filter));
  define("WINDOW_KERNEL", request.window == ShaderWindow::kernel ? 1 : 0);
  define("KERNELS", static_cast<std::int64_t>(coefficients.kernels.size()));
  define("WIDTH", coefficients.extent().width);
  define("HEIGHT", coefficients.extent().height);
  define("TEXELS_X", recipe.textures.front().size.width);
  define("TEXELS_Y", recipe.textures.front().size.height);
  const int groups = (coefficients.channels() + group_channels - 1) / group_channels;
  recipe.useful_fetches = grid.intensity() * texton.support_area * fetches_of(texton.order, request) * groups;
  return recipe;
}

}  // namespace textonbench
