#include "methods/sparse/wave_shader.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <utility>

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

/// kx and ky in 16 bits.
std::uint32_t packed(std::int32_t kx, std::int32_t ky) {
  return (static_cast<std::uint32_t>(kx) & 0xFFFFU) | (static_cast<std::uint32_t>(ky) << 16U);
}

/// The buffer "tables".
class TableWriter {
 public:
  TableWriter(int channels, std::size_t layers, std::int64_t base_x, std::int64_t base_y)
      : channels_(channels), base_x_(base_x), base_y_(base_y), body_(layer_words * layers) {}

  int channels() const { return channels_; }
  std::int64_t base_x() const { return base_x_; }
  std::int64_t base_y() const { return base_y_; }
  /// Place of the next word.
  std::size_t next() const { return body_ + words_.size(); }
  void add(std::uint32_t word) { words_.push_back(word); }
  void add(float v) { add(std::bit_cast<std::uint32_t>(v)); }
  void count_fetches(double fetches) { fetches_ += fetches; }
  /// Words that a point reads.
  double fetches() const { return fetches_; }

  void add_layer(const WaveField& field, std::size_t number, Seed seed) {
    const WaveLayer& layer = field.layers[number];
    const std::size_t first = next();
    words_.insert(words_.end(), layer.first.begin(), layer.first.end());
    add_header(WaveLattice(field, number, seed), first, next());
    add_bins(layer, field.channels);
    count_fetches(9.0 * layer.waves() * (2 + layer.colors + 2.0 * channels_));
  }

  std::vector<std::uint32_t> take() {
    headers_.insert(headers_.end(), words_.begin(), words_.end());
    return std::move(headers_);
  }

 private:
  /// The shader's WaveLayer.
  void add_header(const WaveLattice& lattice, std::size_t first, std::size_t bins) {
    const std::int64_t cell_x = lattice.nearest_x(base_x_), cell_y = lattice.nearest_y(base_y_);
    const std::int64_t center_x = lattice.center_x(cell_x) - base_x_, center_y = lattice.center_y(cell_y) - base_y_;
    add_wide(headers_, lattice.key());
    add_wide(headers_, static_cast<std::uint64_t>(cell_x));
    add_wide(headers_, static_cast<std::uint64_t>(cell_y));
    const WaveLayer& layer = lattice.layer();
    for (const std::uint32_t word :
         {coarse_part(center_x), coarse_part(center_y), fine_part(center_x), fine_part(center_y),
          coarse_part(layer.spacing), fine_part(layer.spacing), static_cast<std::uint32_t>(layer.waves()),
          static_cast<std::uint32_t>(layer.colors), static_cast<std::uint32_t>(first),
          static_cast<std::uint32_t>(bins)}) {
      headers_.push_back(word);
    }
  }

  /// Of each bin its number, thresholds of its colors but the last, and its colors of the first `channels`.
  void add_bins(const WaveLayer& layer, int field_channels) {
    const auto colors = static_cast<std::size_t>(layer.colors), stride = static_cast<std::size_t>(field_channels);
    for (std::size_t bin = 0; bin < layer.bins.size(); ++bin) {
      add(packed(layer.bins[bin].kx, layer.bins[bin].ky));
      for (std::size_t v = 0; v + 1 < colors; ++v) add(layer.chance[bin * colors + v]);
      for (std::size_t v = 0; v < colors; ++v) {
        for (std::size_t c = 0; c < static_cast<std::size_t>(channels_); ++c) {
          const std::complex<float> color = layer.color[(bin * colors + v) * stride + c];
          add(color.real());
          add(color.imag());
        }
      }
    }
  }

  int channels_;
  std::int64_t base_x_, base_y_;
  std::size_t body_;
  std::vector<std::uint32_t> headers_, words_;
  double fetches_ = 0;
};

/// Layers of one channel as those of a field: its other channels are zero.
std::vector<WaveField> as_channel_0(std::vector<WaveField> fields, int channels) {
  for (WaveField& field : fields) {
    WaveLayer& layer = field.layers.front();
    std::vector<std::complex<float>> color(layer.color.size() * static_cast<std::size_t>(channels));
    for (std::size_t i = 0; i < layer.color.size(); ++i) color[i * static_cast<std::size_t>(channels)] = layer.color[i];
    layer.color = std::move(color);
    field.channels = channels;
  }
  return fields;
}

std::int32_t remainder(std::int64_t a, std::int64_t b) { return static_cast<std::int32_t>(((a % b) + b) % b); }

/// What fixed_phases.glsl reads.
void add_structure(const FixedPhases& fixed, Seed seed, TableWriter& table, ShaderRecipe& recipe) {
  const Structure& structure = fixed.structure;
  const auto set = [&](const char* name, ShaderValue value) { recipe.uniforms.emplace_back(name, std::move(value)); };
  set("structure_first", static_cast<std::uint32_t>(table.next()));
  set("structure_cosines", std::int32_t{structure.cosines()});
  set("structure_period", std::int32_t{structure.period()});
  set("block_side", std::int32_t{structure.block_side()});
  set("block_period", std::int32_t{structure.block_period()});
  const int across = structure.period() / structure.block_side();
  for (int i = 0; i < across * across; ++i) {
    const PaddedWaves waves = structure.block(i % across, i / across);
    for (int j = 0; j < structure.cosines(); ++j) {
      table.add(packed(waves.kx[j], waves.ky[j]));
      for (int c = 0; c < table.channels(); ++c) {
        const float* color = waves.color + std::ptrdiff_t{2} * c * waves.padded + j;
        table.add(color[0]);
        table.add(color[waves.padded]);
      }
    }
  }
  table.count_fetches(structure.cosines_at_point() * (1 + 2.0 * table.channels()));
  const std::int64_t x = table.base_x() >> plane_bits, y = table.base_y() >> plane_bits;
  const int half = structure.period() / 2;
  set("structure_base", std::array{remainder(x, structure.period()), remainder(y, structure.period())});
  const FixedPhases::Displacement by = fixed.displacement();
  set("turbulence_scale", static_cast<float>(by.scale));
  set("turbulence_mean", static_cast<float>(by.mean));
  set("placement", std::int32_t{fixed.placement ? 1 : 0});
  std::vector<std::uint32_t> key, block;
  add_wide(key, placement_stream(seed).key());
  add_wide(block, static_cast<std::uint64_t>((x - remainder(x, half)) / half));
  add_wide(block, static_cast<std::uint64_t>((y - remainder(y, half)) / half));
  set("placement_key", std::array{key[0], key[1]});
  set("placement_base", std::array{block[0], block[1], block[2], block[3]});
  set("placement_start", std::array{remainder(x, half), remainder(y, half)});
}

}  // namespace

ShaderRecipe wave_recipe(const WaveField& field, const FixedPhases* fixed, std::span<const double> mean,
                         const ShaderRequest& request) {
  require_shader_limits(field, request);
  ShaderRecipe recipe;
  recipe.shader = "local_random_phase";
  recipe.gradients = true;
  recipe.channels = request.channels > 0 && request.channels < field.channels ? request.channels : field.channels;
  recipe.base = {std::round(request.near.x()), std::round(request.near.y())};
  constexpr auto pixel = static_cast<double>(std::int64_t{1} << plane_bits);
  const auto base_x = static_cast<std::int64_t>(recipe.base.x() * pixel);
  const auto base_y = static_cast<std::int64_t>(recipe.base.y() * pixel);

  std::vector<WaveField> turbulent;
  if (fixed != nullptr) turbulent = as_channel_0(fixed->turbulent, field.channels);
  TableWriter table(recipe.channels, field.layers.size() + 2 * turbulent.size(), base_x, base_y);
  for (std::size_t l = 0; l < field.layers.size(); ++l) table.add_layer(field, l, request.seed);
  for (const bool along_y : {false, true}) {
    for (std::size_t l = 0; l < turbulent.size(); ++l) {
      table.add_layer(turbulent[l], 0, turbulence_seed(request.seed, along_y, l));
    }
  }
  if (fixed != nullptr) add_structure(*fixed, request.seed, table, recipe);
  recipe.useful_fetches = table.fetches();
  recipe.words.push_back({"tables", table.take()});
  recipe.defines.emplace_back("STRUCTURE", fixed != nullptr ? "1" : "0");
  recipe.defines.emplace_back("TURBULENT", std::to_string(turbulent.size()));

  const auto& polynomial = lrp_window_polynomial(field.window);
  recipe.uniforms.emplace_back("window_terms", std::vector<float>(polynomial.begin(), polynomial.end()));
  recipe.uniforms.emplace_back("turn_shift", static_cast<std::int32_t>(most_side_bits - field.side_bits));
  const auto drawn = mean.first(static_cast<std::size_t>(recipe.channels));
  recipe.uniforms.emplace_back("start", std::vector<float>(drawn.begin(), drawn.end()));
  recipe.defines.emplace_back("LAYERS", std::to_string(field.layers.size()));
  recipe.defines.emplace_back("TERMS", std::to_string(polynomial.size()));
  recipe.defines.emplace_back("EVEN", field.even_variance ? "1" : "0");
  return recipe;
}

}  // namespace textonbench
