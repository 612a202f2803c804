#include "methods/spot/kernel_texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <string>

namespace textonbench {
namespace {

constexpr int most_kernel_channels = 8;
constexpr int group_channels = 4;  // of a layer

bool is_filtered(const ShaderRequest& request) { return request.filter != ShaderFilter::none; }

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

}  // namespace

void require_shader_kernels(const SplineTexton& texton, const ShaderRequest& request) {
  const int order = texton.order;
  if (texton.coefficients.channels() > most_kernel_channels) {
    throw std::invalid_argument(fmt::format("shader for texton noise of {} channels: expected at most {}",
                                            texton.coefficients.channels(), most_kernel_channels));
  }
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

void add_kernels_to(ShaderRecipe& recipe, const SplineTexton& texton, double scale, const ShaderRequest& request) {
  const Texton& coefficients = texton.coefficients;
  recipe.textures.push_back(texton_texture(coefficients, scale, request));
  recipe.gradients = texton.order >= 1 && !is_filtered(request);
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
  define("TEXELS_X", recipe.textures.back().size.width);
  define("TEXELS_Y", recipe.textures.back().size.height);
}

int fetches_an_impact(const SplineTexton& texton, const ShaderRequest& request) {
  const int order = texton.order;
  const int groups = (texton.coefficients.channels() + group_channels - 1) / group_channels;
  if (request.fetch == ShaderFetch::manual && !is_filtered(request)) {
    return (order + 1) * (order + 1) * groups;
  }
  return order == 3 ? 4 * groups : groups;
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

int shader_process(ImpactProcess process) {
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

}  // namespace textonbench
