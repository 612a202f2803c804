#include "methods/sparse/gabor_shader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace textonbench {
namespace {

constexpr int most_drawn_channels = 8;
constexpr double furthest_base = 0x1p40;
constexpr double widest_cell = 0x1p18;
constexpr std::size_t band_words = 22;
constexpr std::int64_t coarse_pixel = 1024;

void require_gabor_limits(const GaborField& field, const ShaderRequest& request, int channels) {
  if ((request.filter != ShaderFilter::none && request.filter != ShaderFilter::anisotropic) || request.half_float) {
    throw std::invalid_argument(
        "shader for gabor with mip levels or texels of 16 bits: it has no texels; expected filter none, or anisotropic "
        "for kernels that are filtered in closed form");
  }
  if (request.filter != ShaderFilter::none && request.window == ShaderWindow::kernel) {
    throw std::invalid_argument(
        "shader for gabor with filtered kernels in the window of unfiltered ones: expected the window of the "
        "footprint");
  }
  if (field.process == ImpactProcess::paper) {
    throw std::invalid_argument(
        "shader for gabor with the impacts of another paper's shader: expected poisson, signed_poisson or stratified");
  }
  if (channels > most_drawn_channels) {
    throw std::invalid_argument(
        fmt::format("shader for gabor of {} channels: expected at most {}", channels, most_drawn_channels));
  }
  if (!(request.near.cwiseAbs().maxCoeff() <= furthest_base)) {
    throw std::invalid_argument(
        fmt::format("shader for gabor near ({}, {}): expected a point within 2^40 pixels of the origin",
                    request.near.x(), request.near.y()));
  }
  for (const GaborBand& band : field.bands) {
    for (const GaborFrequency& f : band.frequency) {
      if (!(std::max(std::abs(f.x), std::abs(f.y)) <= 1)) {
        throw std::invalid_argument(
            fmt::format("shader for gabor with a frequency of ({}, {}): expected at most a cycle a pixel", f.x, f.y));
      }
    }
  }
}

std::int64_t floor_cell(std::int64_t a, std::int64_t b) { return a / b - (a % b < 0 ? 1 : 0); }

/// In 2^−31 cycle a pixel.
std::uint32_t frequency_word(double f) {
  return static_cast<std::uint32_t>(std::min<std::int64_t>(std::llround(f * 0x1p31), 0x7FFFFFFF));
}

class GaborTables {
 public:
  GaborTables(const GaborField& field, Seed seed, int channels, std::int64_t base_x, std::int64_t base_y)
      : field_(field),
        seed_(seed),
        channels_(static_cast<std::size_t>(channels)),
        base_x_(base_x),
        base_y_(base_y),
        body_(band_words * field.bands.size()) {
    for (std::size_t b = 0; b < field.bands.size(); ++b) add_band(b);
  }

  /// The buffers "tables" and "thresholds".
  std::vector<std::uint32_t> tables() const {
    std::vector<std::uint32_t> all = headers_;
    all.insert(all.end(), words_.begin(), words_.end());
    return all;
  }
  const std::vector<std::uint32_t>& thresholds() const { return thresholds_; }

 private:
  /// The shader's GaborBand.
  void add_band(std::size_t number) {
    const GaborBand& band = field_.bands[number];
    const GaborImpacts impacts(field_, number, seed_);
    const ImpactGrid& grid = impacts.grid();
    if (!(grid.side() <= widest_cell)) {
      throw std::invalid_argument(
          fmt::format("shader for gabor with cells of {} pixels: expected at most 2^18", grid.side()));
    }
    const std::int64_t side = grid.coarse_side();
    const std::int64_t cell_x = floor_cell(base_x_, side), cell_y = floor_cell(base_y_, side);
    put_wide(static_cast<std::uint64_t>(cell_x)), put_wide(static_cast<std::uint64_t>(cell_y));
    put(cell_x * side - base_x_), put(cell_y * side - base_y_);
    put_wide(impacts.key());
    put(side);
    put(thresholds_.size());
    thresholds_.insert(thresholds_.end(), grid.thresholds().begin(), grid.thresholds().end());
    put(thresholds_.size());
    put_wide(impacts.kernel_key());
    put(band.threshold.size());
    put(body_ + words_.size());
    for (std::size_t e = 0; e < band.threshold.size(); ++e) {
      words_.push_back(band.threshold[e]);
      words_.push_back(band.alias[e]);
    }
    put(body_ + words_.size());
    add_kernels(band);
    const GaborWindow& window = band.window;
    const double area = 1 / window.determinant();
    for (const double v : {window.yy * area, -window.xy * area, window.xx * area, area, window.limit()}) put_float(v);
    double lowest = 2;
    for (const GaborFrequency& f : band.frequency) lowest = std::min(lowest, f.x * f.x + f.y * f.y);
    put_float(lowest);
  }

  void add_kernels(const GaborBand& band) {
    const auto stride = static_cast<std::size_t>(field_.channels);
    for (std::size_t e = 0; e < band.frequency.size(); ++e) {
      words_.push_back(frequency_word(band.frequency[e].x));
      words_.push_back(frequency_word(band.frequency[e].y));
      for (std::size_t c = 0; c < channels_; ++c) {
        words_.push_back(std::bit_cast<std::uint32_t>(band.color[e * stride + c].real()));
        words_.push_back(std::bit_cast<std::uint32_t>(band.color[e * stride + c].imag()));
      }
    }
  }

  template <class Integer>
  void put(Integer v) {
    headers_.push_back(static_cast<std::uint32_t>(v));
  }
  void put_wide(std::uint64_t v) { put(v), put(v >> 32U); }
  void put_float(double v) { headers_.push_back(std::bit_cast<std::uint32_t>(static_cast<float>(v))); }

  const GaborField& field_;
  Seed seed_;
  std::size_t channels_;
  std::int64_t base_x_, base_y_;  // in 2^−10 pixel
  std::size_t body_;
  std::vector<std::uint32_t> headers_, words_, thresholds_;
};

}  // namespace

ShaderRecipe gabor_recipe(const GaborField& field, std::span<const double> mean, const ShaderRequest& request) {
  ShaderRecipe recipe;
  recipe.shader = "gabor";
  recipe.gradients = true;
  recipe.channels = request.channels > 0 && request.channels < field.channels ? request.channels : field.channels;
  require_gabor_limits(field, request, recipe.channels);
  recipe.base = {std::round(request.near.x()), std::round(request.near.y())};
  const std::int64_t base_x = static_cast<std::int64_t>(recipe.base.x()) * coarse_pixel;
  const std::int64_t base_y = static_cast<std::int64_t>(recipe.base.y()) * coarse_pixel;
  const GaborTables tables(field, request.seed, recipe.channels, base_x, base_y);
  recipe.words.push_back({"tables", tables.tables()});

  const auto define = [&](const char* name, const std::string& value) { recipe.defines.emplace_back(name, value); };
  define("BANDS", std::to_string(field.bands.size()));
  define("UNIFORM_WEIGHT", field.weight == GaborWeight::uniform ? "1" : "0");
  define("FILTERED", request.filter == ShaderFilter::anisotropic ? "1" : "0");
  if (field.phase != GaborPhase::random) {
    define("FIXED_PHASE", field.phase == GaborPhase::cosine ? "0u" : "0xC0000000u");
  }
  if (field.process == ImpactProcess::stratified) {
    define("PROCESS", "STRATIFIED");
  } else {
    define("PROCESS", field.process == ImpactProcess::poisson ? "POISSON" : "SIGNED_POISSON");
    recipe.words.push_back({"thresholds", tables.thresholds()});
    // A buffer is never empty; the shader does not look.
    if (tables.thresholds().empty()) recipe.words.back().words.push_back(0);
  }
  constexpr int below_coarse = plane_bits - 10;
  const auto x = static_cast<std::uint64_t>(base_x) << below_coarse;
  const auto y = static_cast<std::uint64_t>(base_y) << below_coarse;
  const auto low = [](std::uint64_t v) { return static_cast<std::uint32_t>(v); };
  recipe.uniforms.emplace_back("base_place", std::array{low(x), low(x >> 32U), low(y), low(y >> 32U)});
  const auto drawn = mean.first(static_cast<std::size_t>(recipe.channels));
  recipe.uniforms.emplace_back("start", std::vector<float>(drawn.begin(), drawn.end()));
  // Threshold and alias, frequency and color.
  const double words = 4 + 2.0 * recipe.channels;
  for (const GaborBand& band : field.bands) recipe.useful_fetches += band.intensity * band.window.area() * words;
  return recipe;
}

}  // namespace textonbench
