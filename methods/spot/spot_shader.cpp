#include "methods/spot/spot_shader.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <string>

#include "methods/base/poisson_rejection.h"
#include "methods/spot/kernel_texture.h"

namespace textonbench {
namespace {

constexpr std::int64_t pixel_units = 1024;  // of PlanePoint, a pixel
constexpr double furthest_grid_place = 0x1p40;
constexpr std::int64_t widest_spot_cell = pixel_units << 18;
constexpr int widest_spot = 1 << 16;

void require_spot_limits(const SpotKernels& kernels, const SpotNoiseOptions& options, double intensity,
                         const ShaderRequest& request) {
  if (options.impacts == Impacts::gaussian) {
    throw std::invalid_argument(
        "shader for spot noise of infinitely many impacts: expected impacts = poisson or stratified");
  }
  if (options.impacts == Impacts::poisson && intensity >= dense_intensity) {
    throw std::invalid_argument(fmt::format(
        "shader for spot noise of {} Poisson impacts a pixel: from {} on, numbers are drawn pixel by pixel; "
        "take fewer (mni), or impacts = stratified",
        intensity, dense_intensity));
  }
  if (request.filter != ShaderFilter::none) {
    throw std::invalid_argument(
        "filtered kernels of spot noise: it has values at whole points of the plane alone; expected filter none");
  }
  if (std::max(kernels.extent().width, kernels.extent().height) > widest_spot) {
    throw std::invalid_argument(fmt::format("shader for spot noise with kernels of {}x{}: expected at most 2^16 pixels",
                                            kernels.extent().width, kernels.extent().height));
  }
  if (!(request.near.cwiseAbs().maxCoeff() <= furthest_grid_place)) {
    throw std::invalid_argument(
        fmt::format("shader for spot noise near ({}, {}): expected a point within 2^40 pixels of the origin",
                    request.near.x(), request.near.y()));
  }
}

std::array<std::uint32_t, 2> halves(std::uint64_t v) {
  return {static_cast<std::uint32_t>(v), static_cast<std::uint32_t>(v >> 32U)};
}

/// What gpu/shaders/poisson_number.glsl reads.
void add_poisson_to(ShaderRecipe& recipe, double mean) {
  std::vector<double> numbers{mean};
  const bool by_arrivals = mean < least_rejection_mean;
  if (!by_arrivals) {
    const PoissonRejection rejection = poisson_rejection(mean);
    numbers.insert(numbers.end(), {rejection.a, rejection.b, rejection.inverse_alpha, rejection.v_r});
    // Uniform numbers of at least 2^−53 make logarithms above −120, so no larger candidate is ever taken.
    constexpr double least_logarithm = -120;
    double logarithm = 0;
    for (int k = 0; k <= mean || logarithm > least_logarithm; ++k) {
      logarithm = log_poisson(k, mean);
      numbers.push_back(logarithm);
    }
    recipe.defines.emplace_back("LOGARITHMS", std::to_string(numbers.size() - 5));
  }
  recipe.defines.emplace_back("ARRIVALS", by_arrivals ? "1" : "0");
  std::vector<std::uint32_t> words;
  words.reserve(2 * numbers.size());
  for (const double v : numbers) {
    const auto [low, high] = halves(std::bit_cast<std::uint64_t>(v));
    words.push_back(low);
    words.push_back(high);
  }
  recipe.words.push_back({"poisson_numbers", std::move(words)});
}

/// Cells of `side` in 2^−10 pixel, counted from the one that holds the base.
void add_cells_to(ShaderRecipe& recipe, const Stream& stream, std::int64_t side, int kernels) {
  const auto cell_of = [&](double base) {
    const std::int64_t units = std::llround(base) * pixel_units;
    return units / side - (units % side < 0 ? 1 : 0);
  };
  const std::int64_t x = cell_of(recipe.base.x()), y = cell_of(recipe.base.y());
  const auto [x_low, x_high] = halves(static_cast<std::uint64_t>(x));
  const auto [y_low, y_high] = halves(static_cast<std::uint64_t>(y));
  const auto corner = [&](std::int64_t cell, double base) {
    return static_cast<std::int32_t>(cell * side - std::llround(base) * pixel_units);
  };
  // 2^64 modulo a number.
  const auto refused_of = [](std::uint64_t bound) { return static_cast<std::uint32_t>((0 - bound) % bound); };
  recipe.uniforms.emplace_back("base_cell", std::array{x_low, x_high, y_low, y_high});
  recipe.uniforms.emplace_back("base_corner", std::array{corner(x, recipe.base.x()), corner(y, recipe.base.y())});
  recipe.uniforms.emplace_back("key", halves(stream.key()));
  recipe.uniforms.emplace_back("cell_side", static_cast<std::int32_t>(side));
  recipe.uniforms.emplace_back("refused", std::array{refused_of(static_cast<std::uint64_t>(side)),
                                                     refused_of(static_cast<std::uint64_t>(kernels))});
}

double sum_of_values(const SpotKernels& kernels, int channel) {
  double sum = 0;
  for (const Image& kernel : kernels.images) {
    for (int y = 0; y < kernel.height(); ++y) {
      for (const float v : kernel.row(channel, y)) sum += v;
    }
  }
  return sum;
}

}  // namespace

ShaderRecipe spot_noise_recipe(const SpotKernels& kernels, const std::vector<double>& mean, std::int64_t support_pixels,
                               const SpotNoiseOptions& options, const ShaderRequest& request) {
  double intensity = options.mni / static_cast<double>(support_pixels);
  require_spot_limits(kernels, options, intensity, request);
  const Stream stream = Stream(request.seed).child("spot noise");
  const bool is_stratified = options.impacts == Impacts::stratified;
  const PoissonCells cells = poisson_cells(intensity);
  std::int64_t side = pixel_units << cells.shift;
  if (is_stratified) {
    const CellLattice lattice = plane_lattice(intensity);
    intensity = lattice.intensity();
    side = lattice.x.numerator * pixel_units / lattice.x.denominator;
  }
  if (side > widest_spot_cell) {
    throw std::invalid_argument(fmt::format("shader for spot noise with cells of {} pixels: expected at most 2^18",
                                            static_cast<double>(side) / static_cast<double>(pixel_units)));
  }
  ShaderRecipe recipe;
  recipe.shader = "spot_noise";
  recipe.on_grid = true;
  recipe.base = {std::floor(request.near.x()), std::floor(request.near.y())};
  add_cells_to(recipe, stream.child(is_stratified ? "stratified" : "poisson"), side, kernels.count());
  recipe.defines.emplace_back(
      "PROCESS", std::to_string(shader_process(is_stratified ? ImpactProcess::stratified : ImpactProcess::poisson)));
  if (!is_stratified) add_poisson_to(recipe, cells.mean);

  const double scale = std::sqrt(kernels.count() / intensity);
  const double mean_weight = is_stratified ? 0 : intensity / kernels.count();
  SplineTexton texton{.coefficients = {.kernels = kernels.images, .support_pixels = support_pixels, .mean = mean},
                      .order = 0,
                      .support_area = static_cast<double>(support_pixels)};
  if (request.channels > 0 && request.channels < kernels.channels()) texton = first_channels(texton, request.channels);
  recipe.channels = texton.coefficients.channels();
  std::vector<float> start;
  start.reserve(static_cast<std::size_t>(recipe.channels));
  for (int c = 0; c < recipe.channels; ++c) {
    start.push_back(
        static_cast<float>(mean[static_cast<std::size_t>(c)] - scale * mean_weight * sum_of_values(kernels, c)));
  }
  recipe.uniforms.emplace_back("start", std::move(start));
  add_kernels_to(recipe, texton, scale, request);
  const Extent box = kernels.extent();
  recipe.useful_fetches = intensity * static_cast<double>(support_pixels) * fetches_an_impact(texton, request);
  const double cell = static_cast<double>(side) / static_cast<double>(pixel_units);
  const double reached = (box.width + 2 * cell) * (box.height + 2 * cell);
  // Impacts of all cells that the kernels' box meets, and the cells and the steps that their numbers take.
  recipe.turns = reached * (intensity + (2 + cells.mean) / (cell * cell));
  return recipe;
}

}  // namespace textonbench
