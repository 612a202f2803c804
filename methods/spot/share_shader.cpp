#include "methods/spot/share_shader.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "methods/base/impact_grid.h"

namespace textonbench {
namespace {

constexpr int coarse_bits = 10;  // of PlanePoint
constexpr double coarse_unit = 1 << coarse_bits;
constexpr int fine_bits = plane_bits - coarse_bits;

std::int64_t coarse_base(double base) { return std::llround(base * coarse_unit); }

/// Corners relative to the base, in 2^−10 pixel and the 12 bits below; those that no point of a frame comes near are
/// the furthest that there are.
std::vector<std::uint32_t> border_words(const std::vector<std::int64_t>& borders, std::int64_t base) {
  std::vector<std::uint32_t> words;
  words.reserve(2 * borders.size());
  for (const std::int64_t border : borders) {
    constexpr std::int64_t least = std::numeric_limits<std::int32_t>::min();
    constexpr std::int64_t greatest = std::numeric_limits<std::int32_t>::max();
    const std::int64_t coarse = (border >> fine_bits) - base;
    words.push_back(static_cast<std::uint32_t>(std::clamp(coarse, least, greatest)));
    words.push_back(static_cast<std::uint32_t>(border & ((1 << fine_bits) - 1)));
  }
  return words;
}

void add_ramp_to(ShaderRecipe& recipe, const PlaneShare& share, Extent box, int kernels) {
  recipe.words.push_back(
      {"share_borders", border_words(ramp_borders(share, box, kernels), coarse_base(recipe.base.x()))});
  // Distances are taken from the ramp's start, or from the place nearest to it that frames may reach.
  constexpr double furthest = 0x1p30;
  const double from_base = (share.start() - recipe.base.x()) * coarse_unit;
  const double anchor = std::floor(std::clamp(from_base, -furthest, furthest));
  recipe.uniforms.emplace_back("share_anchor", static_cast<std::int32_t>(anchor));
  recipe.uniforms.emplace_back("anchor_share", static_cast<float>((anchor - from_base) / coarse_unit / share.length()));
  recipe.uniforms.emplace_back("share_slope", static_cast<float>(1 / share.length()));
}

/// Corner (0, 0) of a raster whose pixels have their centers at whole points, moved by `shift` in 2^−10 pixel, from the
/// base: whole pixels and what is left, in 2^−10 pixel.
std::array<std::int32_t, 4> map_corner(const ShaderRecipe& recipe, std::int64_t shift_x, std::int64_t shift_y) {
  constexpr std::int64_t furthest = 1 << 30;  // more than the pixels of any picture beyond any point of a frame
  const std::int64_t x = -coarse_base(recipe.base.x()) - shift_x;
  const std::int64_t y = -coarse_base(recipe.base.y()) - shift_y;
  constexpr std::int64_t part = (1 << coarse_bits) - 1;
  return {static_cast<std::int32_t>(std::clamp(x >> coarse_bits, -furthest, furthest)),
          static_cast<std::int32_t>(std::clamp(y >> coarse_bits, -furthest, furthest)),
          static_cast<std::int32_t>(x & part), static_cast<std::int32_t>(y & part)};
}

void add_map_to(ShaderRecipe& recipe, const PlaneShare& share, Extent box, int kernels) {
  const Image& picture = share.picture();
  ShaderTexture texture;
  texture.sampler = "share_map";
  texture.size = picture.extent();
  std::vector<float>& texels = texture.levels.emplace_back();
  texels.reserve(static_cast<std::size_t>(picture.extent().area()));
  for (int y = 0; y < picture.height(); ++y) {
    for (const float v : picture.row(0, y)) {
      texels.push_back(v + 0.0F);  // no −0, whose bits are above all others
    }
  }
  recipe.textures.push_back(std::move(texture));
  recipe.words.push_back({"share_borders", share_borders(kernels)});
  const auto add_corner = [&](const std::string& name, const std::array<std::int32_t, 4>& corner) {
    recipe.uniforms.emplace_back(name, std::array{corner[0], corner[1]});
    recipe.uniforms.emplace_back(name + "_part", std::array{corner[2], corner[3]});
  };
  // floor(c + 1/2) of the center c = corner + (size − 1) / 2, or of the point.
  constexpr std::int64_t half = 1 << (coarse_bits - 1);
  add_corner("kernel_map", map_corner(recipe, half * box.width, half * box.height));
  add_corner("point_map", map_corner(recipe, half, half));
}

}  // namespace

void add_share_to(ShaderRecipe& recipe, const PlaneShare& share, Extent box, int kernels) {
  int kind = 1;
  switch (share.kind()) {
    case PlaneShare::Kind::uniform:
      recipe.uniforms.emplace_back("share", static_cast<float>(share.at(0, 0)));
      recipe.uniforms.emplace_back("share_kernel", static_cast<std::int32_t>(share.kernel_at(0, 0, kernels)));
      break;
    case PlaneShare::Kind::ramp:
      kind = 2;
      add_ramp_to(recipe, share, box, kernels);
      break;
    case PlaneShare::Kind::map:
      kind = 3;
      add_map_to(recipe, share, box, kernels);
      break;
  }
  recipe.defines.emplace_back("SHARE", std::to_string(kind));
}

void add_means_to(ShaderRecipe& recipe, std::span<const double> first, std::span<const double> second) {
  std::vector<float> at_first, change;
  for (std::size_t c = 0; c < static_cast<std::size_t>(recipe.channels); ++c) {
    at_first.push_back(static_cast<float>(first[c]));
    change.push_back(static_cast<float>(second[c] - first[c]));
  }
  recipe.defines.emplace_back("SHARED_MEAN", "1");
  recipe.uniforms.emplace_back("first_mean", std::move(at_first));
  recipe.uniforms.emplace_back("mean_change", std::move(change));
}

}  // namespace textonbench
