#include "methods/spot/spot_noise.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "methods/base/convolution.h"
#include "methods/base/parallel.h"
#include "methods/exemplar_spot.h"
#include "methods/spot/spot_shader.h"
#include "methods/spot/spot_sum.h"

namespace textonbench {
namespace {

/// Impacts a pixel that can be drawn: below, cells would be wider than a million pixels; above, Poisson numbers would
/// no longer fit 53 bits, and stratified impacts, which are drawn one by one, would take minutes for a megapixel.
constexpr double least_intensity = 1e-12;
constexpr double greatest_poisson_intensity = 1e12;
constexpr double greatest_stratified_intensity = 64;

void require_intensity(const SpotNoiseOptions& options, std::int64_t support_pixels) {
  if (!(std::isfinite(options.mni) && options.mni > 0)) {
    throw std::invalid_argument(fmt::format("mni = {}: expected a finite mean number of impacts above 0", options.mni));
  }
  const double intensity = options.mni / static_cast<double>(support_pixels);
  const double greatest =
      options.impacts == Impacts::stratified ? greatest_stratified_intensity : greatest_poisson_intensity;
  if (options.impacts != Impacts::gaussian && !(intensity >= least_intensity && intensity <= greatest)) {
    throw std::invalid_argument(fmt::format(
        "mni = {} on a support of {} pixels puts {} impacts on each pixel: expected {} to {} for {} impacts; "
        "impacts = gaussian is the limit of infinitely many",
        options.mni, support_pixels, intensity, least_intensity, greatest,
        options.impacts == Impacts::stratified ? "stratified" : "poisson"));
  }
}

void require_texton(const Texton& texton) {
  if (texton.kernels.empty() || texton.kernels.front().empty()) {
    throw std::invalid_argument("texton without kernels: expected at least one");
  }
  bool any = false;
  for (const Image& kernel : texton.kernels) {
    if (kernel.extent() != texton.extent() || kernel.channels() != texton.channels()) {
      throw std::invalid_argument(
          fmt::format("texton with kernels of {}x{}x{} and {}x{}x{}: expected one size and number of channels",
                      texton.extent().width, texton.extent().height, texton.channels(), kernel.width(), kernel.height(),
                      kernel.channels()));
    }
    if (const auto place = find_non_finite(kernel)) {
      throw std::invalid_argument(fmt::format("texton with the value {} at ({}, {}): expected finite numbers",
                                              kernel.at(place->channel, place->x, place->y), place->x, place->y));
    }
    for (int i = 0; i < kernel.channels() * kernel.height() && !any; ++i) {
      const auto row = kernel.row(i / kernel.height(), i % kernel.height());
      any = std::ranges::any_of(row, [](float v) { return v != 0; });
    }
  }
  if (!any) {
    throw std::invalid_argument("texton that is zero everywhere: expected a value other than 0");
  }
  if (texton.support_pixels < 1 || texton.support_pixels > texton.extent().area()) {
    throw std::invalid_argument(fmt::format("texton with a support of {} pixels: expected 1 to {}",
                                            texton.support_pixels, texton.extent().area()));
  }
  if (texton.mean.size() != static_cast<std::size_t>(texton.channels()) ||
      !std::ranges::all_of(texton.mean, [](double m) { return std::isfinite(m); })) {
    throw std::invalid_argument(
        fmt::format("texton with {} means: expected {} finite numbers", texton.mean.size(), texton.channels()));
  }
}

class SpotNoise final : public Model, public Gaussian {
 public:
  SpotNoise(Texton texton, const SpotNoiseOptions& options, std::optional<Convergence> convergence)
      : texton_(std::move(texton)),
        options_(options),
        convergence_(std::move(convergence)),
        kernels_(texton_.kernels) {}

  Image synthesize(const Domain& domain, Seed seed) const override {
    if (const auto reason = refuse_spot_noise(texton_.extent(), domain)) {
      throw std::invalid_argument(*reason);
    }
    const SumDomain sum{domain.size, domain.periodic};
    const PlaneWindow window = reaching_window(domain);
    const Stream stream = Stream(seed).child("spot noise");
    if (options_.impacts == Impacts::gaussian) {
      return gaussian_sample(window, sum, stream.child("gaussian"));
    }
    const ImpactSet impacts = draw(window, domain, stream);
    const double scale = std::sqrt(kernels_.count() / realized_intensity(domain));
    return route(domain) == SpotRoute::direct ? sum_direct(kernels_, impacts, scale, texton_.mean, sum)
                                              : sum_spectral(kernels_, impacts, scale, texton_.mean, sum);
  }

  const Gaussian* gaussian() const override { return this; }
  std::vector<double> mean() const override { return texton_.mean; }
  CrossSpectrum spectrum(Extent grid) const override {
    CrossSpectrum result;
    result.factors.reserve(texton_.kernels.size());
    for (const Image& kernel : texton_.kernels) {
      result.factors.push_back(forward_fft(wrap(kernel, grid)));
    }
    return result;
  }
  const Texton* texton() const override { return &texton_; }
  const Convergence* convergence() const override { return convergence_ ? &*convergence_ : nullptr; }
  const SpotNoiseOptions& options() const { return options_; }
  std::optional<ShaderRecipe> shader(const ShaderRequest& request) const override {
    return spot_noise_recipe(kernels_, texton_.mean, texton_.support_pixels, options_, request);
  }

  Footprint footprint(const Domain& domain) const override {
    std::size_t bytes = 0;
    for (const Image& kernel : kernels_.images) {
      bytes += kernel.bytes();
    }
    const SumDomain sum{domain.size, domain.periodic};
    const RouteCost cost = route(domain) == SpotRoute::direct ? cost_direct(kernels_, weights_per_pixel(), sum)
                                                              : cost_spectral(kernels_, sum);
    return {bytes, cost.operations / static_cast<double>(domain.size.area())};
  }

 private:
  double intensity() const { return options_.mni / static_cast<double>(texton_.support_pixels); }

  /// Where an impact can reach the domain from: kernels extend to the right of their impact and down.
  PlaneWindow reaching_window(const Domain& domain) const {
    if (domain.periodic) {
      return {0, 0, domain.size};
    }
    const auto [width, height] = kernels_.extent();
    return {static_cast<std::int64_t>(domain.origin.x) - (width - 1),
            static_cast<std::int64_t>(domain.origin.y) - (height - 1),
            {domain.size.width + width - 1, domain.size.height + height - 1}};
  }

  CellLattice lattice(const Domain& domain) const { return impact_lattice(intensity(), domain); }

  /// Stratified cells have to fit the grid or the torus, which changes the intensity a little; sums are normalized by
  /// what it is.
  double realized_intensity(const Domain& domain) const {
    return options_.impacts == Impacts::stratified ? lattice(domain).intensity() : intensity();
  }

  /// The torus of a seed has the Poisson impacts that the plane has there, so the two agree but for wrapped kernels.
  ImpactSet draw(const PlaneWindow& window, const Domain& domain, const Stream& stream) const {
    return options_.impacts == Impacts::stratified
               ? draw_stratified(stream.child("stratified"), lattice(domain), kernels_.count(), window)
               : draw_poisson(stream.child("poisson"), intensity(), kernels_.count(), window);
  }

  /// Kernels laid down a pixel by the direct route.
  double weights_per_pixel() const {
    const bool dense = options_.impacts == Impacts::poisson && intensity() >= dense_intensity;
    return dense ? kernels_.count() : intensity();
  }

  SpotRoute route(const Domain& domain) const {
    if (options_.impacts == Impacts::gaussian) {
      return SpotRoute::spectral;
    }
    if (options_.route != SpotRoute::automatic) {
      return options_.route;
    }
    const SumDomain sum{domain.size, domain.periodic};
    return cost_direct(kernels_, weights_per_pixel(), sum).nanoseconds <= cost_spectral(kernels_, sum).nanoseconds
               ? SpotRoute::direct
               : SpotRoute::spectral;
  }

  /// Σ_k h_k * W_k with an independent white Gaussian noise W_k for each kernel.
  Image gaussian_sample(const PlaneWindow& window, const SumDomain& domain, const Stream& stream) const {
    std::vector<Image> noise(texton_.kernels.size(), Image(window.size, 1));
    for (std::size_t k = 0; k < noise.size(); ++k) {
      const Stream own = stream.child(k);
      parallel_for(window.size.height,
                   [&](int y) { fill_plane_normal(own, window.x, window.y + y, noise[k].row(0, y)); });
    }
    Image sample = domain.periodic ? convolve_circular(kernels_.images, noise) : convolve_valid(kernels_.images, noise);
    add_constant(texton_.mean, sample);
    return sample;
  }

  Texton texton_;
  SpotNoiseOptions options_;
  std::optional<Convergence> convergence_;
  SpotKernels kernels_;
};

Impacts impacts_named(const std::string& name) {
  return name == "gaussian" ? Impacts::gaussian : name == "poisson" ? Impacts::poisson : Impacts::stratified;
}

SpotRoute route_named(const std::string& name) {
  return name == "auto" ? SpotRoute::automatic : name == "direct" ? SpotRoute::direct : SpotRoute::spectral;
}

}  // namespace

std::vector<ParamSpec> spot_noise_params(std::string_view default_impacts) {
  return {
      {.name = "impacts",
       .default_value = std::string(default_impacts),
       .unit = "",
       .help = "where kernels fall: at the points of a Poisson process; one of random sign in each cell of a lattice "
               "(stratified), which has the same covariance and nearly the Gaussian law with fewer impacts; "
               "or the Gaussian limit of infinitely many",
       .choices = {"gaussian", "poisson", "stratified"}},
      {.name = "mni",
       .default_value = 30.0,
       .unit = "impact",
       .help = "mean number of impacts that cover a pixel",
       .min = 1e-6,
       .max = 1e12},
      {.name = "intensity",
       .default_value = 0.0,
       .unit = "impact/pixel",
       .help = "impacts on each pixel, in place of mni; 0: as mni says",
       .min = 0,
       .max = greatest_poisson_intensity},
      {.name = "route",
       .default_value = std::string("auto"),
       .unit = "",
       .help = "how kernels are summed: one by one (direct), by Fourier transform (spectral), or the faster of the two",
       .choices = {"auto", "direct", "spectral"}},
  };
}

SpotNoiseOptions spot_noise_options(const Params& params, std::int64_t support_pixels) {
  const double intensity = params.number("intensity");
  return {.impacts = impacts_named(params.text("impacts")),
          .mni = intensity > 0 ? intensity * static_cast<double>(support_pixels) : params.number("mni"),
          .route = route_named(params.text("route"))};
}

std::unique_ptr<Model> make_spot_noise(Texton texton, const SpotNoiseOptions& options,
                                       std::optional<Convergence> convergence) {
  require_texton(texton);
  require_intensity(options, texton.support_pixels);
  return std::make_unique<SpotNoise>(std::move(texton), options, std::move(convergence));
}

const SpotNoiseOptions* spot_noise_of(const Model& model) {
  const auto* noise = dynamic_cast<const SpotNoise*>(&model);
  return noise == nullptr ? nullptr : &noise->options();
}

CellLattice impact_lattice(double intensity, const Domain& domain) {
  return domain.periodic ? torus_lattice(intensity, domain.size) : plane_lattice(intensity);
}

std::optional<std::string> refuse_spot_noise(Extent texton, const Domain& domain) {
  constexpr int longest = 1 << 29;
  if (domain.size.width > longest || domain.size.height > longest) {
    return fmt::format("spot noise on {}x{} pixels: expected sides of at most {}", domain.size.width,
                       domain.size.height, longest);
  }
  if (domain.periodic && domain.origin != Point2{}) {
    return fmt::format("spot noise on a torus starts at (0, 0), but ({}, {}) was asked for", domain.origin.x,
                       domain.origin.y);
  }
  if (domain.periodic && (domain.size.width < texton.width || domain.size.height < texton.height)) {
    return fmt::format(
        "spot noise on a torus of {}x{}: its kernels of {}x{} would overlap themselves; expected a torus "
        "at least as large, or a domain that is not periodic",
        domain.size.width, domain.size.height, texton.width, texton.height);
  }
  return refuse_off_grid("spot noise", domain);
}

}  // namespace textonbench
