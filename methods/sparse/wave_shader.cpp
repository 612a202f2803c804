#include "methods/sparse/wave_shader.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <stdexcept>

namespace textonbench {
namespace {

constexpr int most_channels = 8;
constexpr int most_side_bits = 10;
constexpr double furthest_place = 0x1p40;
constexpr double widest_spacing = 0x1p18;
constexpr std::size_t layer_words = 16;
constexpr int fine_bits = 12;  // of a coordinate below 2^−10 pixel

void require_shader_limits(const WaveField& field, const ShaderRequest& request) {
  if (request.filter != ShaderFilter::none || request.half_float) {
    throw std::invalid_argument(
        "shader for lrp with a filter of texels or texels of 16 bits: it has no texels; expected filter none, and "
        "footprint = pixels for clamped frequencies");
  }
  if (field.channels > most_channels || field.side_bits > most_side_bits) {
    throw std::invalid_argument(
        fmt::format("shader for lrp of {} channels and blocks of {} pixels: expected at most {} and {}", field.channels,
                    1LL << field.side_bits, most_channels, 1 << most_side_bits));
  }
  if (!(request.near.cwiseAbs().maxCoeff() <= furthest_place)) {
    throw std::invalid_argument(
        fmt::format("shader for lrp near ({}, {}): expected a point within 2^40 pixels of the origin", request.near.x(),
                    request.near.y()));
  }
  for (const WaveLayer& layer : field.layers) {
    if (layer.pixels() > widest_spacing) {
      throw std::invalid_argument(
          fmt::format("shader for lrp with windows {} pixels apart: expected at most 2^18", layer.pixels()));
    }
  }
}

void add_wide(std::vector<std::uint32_t>& words, std::uint64_t v) {
  words.push_back(static_cast<std::uint32_t>(v));
  words.push_back(static_cast<std::uint32_t>(v >> 32U));
}

/// A coordinate in 2^−22 pixel: coarse and fine part.
std::uint32_t coarse_part(std::int64_t at) { return static_cast<std::uint32_t>(at >> fine_bits); }
std::uint32_t fine_part(std::int64_t at) { return static_cast<std::uint32_t>(at & ((1 << fine_bits) - 1)); }

/// The shader's WaveLayer.
std::vector<std::uint32_t> header_of(const WaveLattice& lattice, std::int64_t base_x, std::int64_t base_y,
                                     std::size_t first, std::size_t bins) {
  std::vector<std::uint32_t> words;
  const std::int64_t cell_x = lattice.nearest_x(base_x), cell_y = lattice.nearest_y(base_y);
  const std::int64_t center_x = lattice.center_x(cell_x) - base_x, center_y = lattice.center_y(cell_y) - base_y;
  add_wide(words, lattice.key());
  add_wide(words, static_cast<std::uint64_t>(cell_x));
  add_wide(words, static_cast<std::uint64_t>(cell_y));
  for (const std::uint32_t word :
       {coarse_part(center_x), coarse_part(center_y), fine_part(center_x), fine_part(center_y),
        coarse_part(lattice.layer().spacing), fine_part(lattice.layer().spacing),
        static_cast<std::uint32_t>(lattice.layer().waves()), static_cast<std::uint32_t>(lattice.layer().colors),
        static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(bins)}) {
    words.push_back(word);
  }
  return words;
}

/// Of each bin kx and ky in 16 bits, thresholds of its colors but the last, and its colors of the first `channels`.
void add_bins(const WaveLayer& layer, int field_channels, int channels, std::vector<std::uint32_t>& words) {
  const auto colors = static_cast<std::size_t>(layer.colors), stride = static_cast<std::size_t>(field_channels);
  for (std::size_t bin = 0; bin < layer.bins.size(); ++bin) {
    const auto low = static_cast<std::uint32_t>(layer.bins[bin].kx) & 0xFFFFU;
    words.push_back(low | (static_cast<std::uint32_t>(layer.bins[bin].ky) << 16U));
    for (std::size_t v = 0; v + 1 < colors; ++v) words.push_back(layer.chance[bin * colors + v]);
    for (std::size_t v = 0; v < colors; ++v) {
      for (std::size_t c = 0; c < static_cast<std::size_t>(channels); ++c) {
        const std::complex<float> color = layer.color[(bin * colors + v) * stride + c];
        words.push_back(std::bit_cast<std::uint32_t>(color.real()));
        words.push_back(std::bit_cast<std::uint32_t>(color.imag()));
      }
    }
  }
}

}  // namespace

ShaderRecipe wave_recipe(const WaveField& field, std::span<const double> mean, const ShaderRequest& request) {
  require_shader_limits(field, request);
  ShaderRecipe recipe;
  recipe.shader = "local_random_phase";
  recipe.channels = request.channels > 0 && request.channels < field.channels ? request.channels : field.channels;
  recipe.base = {std::round(request.near.x()), std::round(request.near.y())};
  constexpr auto pixel = static_cast<double>(std::int64_t{1} << plane_bits);
  const auto base_x = static_cast<std::int64_t>(recipe.base.x() * pixel);
  const auto base_y = static_cast<std::int64_t>(recipe.base.y() * pixel);

  std::vector<std::uint32_t> headers, words;
  const std::size_t offset = layer_words * field.layers.size();
  for (std::size_t l = 0; l < field.layers.size(); ++l) {
    const WaveLayer& layer = field.layers[l];
    const std::size_t first = offset + words.size();
    words.insert(words.end(), layer.first.begin(), layer.first.end());
    const std::vector<std::uint32_t> header =
        header_of(WaveLattice(field, l, request.seed), base_x, base_y, first, offset + words.size());
    headers.insert(headers.end(), header.begin(), header.end());
    add_bins(layer, field.channels, recipe.channels, words);
    const double of_wave = 2 + layer.colors + 2.0 * recipe.channels;
    recipe.useful_fetches += 9 * layer.waves() * of_wave;
  }
  headers.insert(headers.end(), words.begin(), words.end());
  recipe.words.push_back({"tables", std::move(headers)});

  const auto& polynomial = lrp_window_polynomial(field.window);
  recipe.uniforms.emplace_back("window_terms", std::vector<float>(polynomial.begin(), polynomial.end()));
  recipe.uniforms.emplace_back("turn_shift", static_cast<std::int32_t>(most_side_bits - field.side_bits));
  std::vector<float> start;
  for (int c = 0; c < recipe.channels; ++c) start.push_back(static_cast<float>(mean[static_cast<std::size_t>(c)]));
  recipe.uniforms.emplace_back("start", std::move(start));
  recipe.defines.emplace_back("LAYERS", std::to_string(field.layers.size()));
  recipe.defines.emplace_back("TERMS", std::to_string(polynomial.size()));
  recipe.defines.emplace_back("EVEN", field.even_variance ? "1" : "0");
  return recipe;
}

}  // namespace textonbench
