#include "methods/spot/mixing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "methods/base/image_io.h"
#include "methods/base/parallel.h"
#include "methods/spot/barycenter.h"
#include "methods/spot/plane_share.h"
#include "methods/spot/share_shader.h"
#include "methods/spot/texton_noise.h"

namespace textonbench {
namespace {

std::vector<ParamSpec> make_mixing_params() {
  std::vector<ParamSpec> all{
      {.name = "second",
       .default_value = std::string(),
       .unit = "exemplar",
       .help = "the texture at the other end, of the size of the first"},
      {.name = "kernels",
       .default_value = std::int64_t{21},
       .unit = "",
       .help = "number of textons from one texture to the other, both ends included",
       .min = 2,
       .max = 256},
      {.name = "start", .default_value = 0.0, .unit = "pixel", .help = "column where the first texture ends"},
      {.name = "length",
       .default_value = 512.0,
       .unit = "pixel",
       .help = "from there to the column where the second begins",
       .min = 1,
       .max = 1e9},
      {.name = "map",
       .default_value = std::string(),
       .unit = "file",
       .help = "instead of start and length: a picture whose first channel is the share of the "
               "second texture at each pixel, 0 to 1; it goes on beyond its borders"},
      {.name = "share",
       .default_value = -1.0,
       .unit = "",
       .help = "instead of start and length: the share of the second texture everywhere, 0 to 1; -1: as they say",
       .min = -1,
       .max = 1}};
  std::ranges::copy(support_params(31), std::back_inserter(all));
  all.push_back(spline_order_param());
  std::ranges::copy(projection_params(), std::back_inserter(all));
  all.push_back(color_correction_param());
  all.push_back(component_param());
  for (ParamSpec& spec : spline_noise_params()) {
    if (spec.name == "impacts") {
      spec.help =
          "where kernels fall, each of random sign: one in each cell of a lattice (stratified), or at the points "
          "of a Poisson process (signed_poisson), which takes several times as many to look as Gaussian";
      spec.choices = {"signed_poisson", "stratified"};
    }
    all.push_back(std::move(spec));
  }
  return all;
}

std::span<const ParamSpec> mixing_params() {
  static const std::vector<ParamSpec> specs = make_mixing_params();
  return specs;
}

SotOptions fit_options(const Params& params) {
  SotOptions options{.component = component_of(params),
                     .start = sot_start_of(params),
                     .projections = projection_options(params),
                     .color_correction = color_correction_of(params)};
  options.projections.order = static_cast<int>(params.integer("order"));
  return options;
}

PlaneShare share_of(const Params& params) {
  const std::string& file = params.text("map");
  const double share = params.number("share");
  if (share >= 0) {
    if (!file.empty()) {
      throw std::invalid_argument(fmt::format(
          "share = {} and map = {}: expected one of them, the same share everywhere or a picture of it", share, file));
    }
    return PlaneShare::uniform(share);
  }
  if (share != -1) {
    throw std::invalid_argument(
        fmt::format("share = {}: expected 0 to 1, or -1 for that of start and length, or of a map", share));
  }
  if (file.empty()) {
    return PlaneShare::ramp(params.number("start"), params.number("length"));
  }
  Image picture = read_image(file).image;
  try {
    return PlaneShare::map(std::move(picture));
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("{}: {}", file, error.what()));
  }
}

class Mixture final : public Model {
 public:
  /// `noise` has mean zero.
  Mixture(std::unique_ptr<Model> noise, PlaneShare share, std::vector<double> first, std::vector<double> second)
      : noise_(std::move(noise)), share_(std::move(share)), first_(std::move(first)), second_(std::move(second)) {}

  Image synthesize(const Domain& domain, Seed seed) const override {
    Image image = noise_->synthesize(domain, seed);
    parallel_for(image.height(), [&](int y) {
      for (int x = 0; x < image.width(); ++x) {
        const double rho = share_.at(domain.origin.x + domain.step * x, domain.origin.y + domain.step * y);
        for (int c = 0; c < image.channels(); ++c) {
          const auto channel = static_cast<std::size_t>(c);
          image.at(c, x, y) += static_cast<float>((1 - rho) * first_[channel] + rho * second_[channel]);
        }
      }
    });
    return image;
  }

  Footprint footprint(const Domain& domain) const override { return noise_->footprint(domain); }

  std::optional<ShaderRecipe> shader(const ShaderRequest& request) const override {
    std::optional<ShaderRecipe> recipe = noise_->shader(request);
    if (recipe) {
      add_means_to(*recipe, first_, second_);
    }
    return recipe;
  }

 private:
  std::unique_ptr<Model> noise_;
  PlaneShare share_;
  std::vector<double> first_, second_;
};

constexpr std::string_view second_missing = "mixing needs two textures: -p second=EXEMPLAR names the other one";

std::optional<std::string> refuse_mixing(const Problem& problem, const Params& params, const Domain& domain) {
  if (problem.second == nullptr) {
    return std::string(second_missing);
  }
  const Extent a = problem.exemplar.pixels.extent();
  const Extent b = problem.second->pixels.extent();
  if (a != b || problem.exemplar.pixels.channels() != problem.second->pixels.channels()) {
    return fmt::format(
        "{} has {}x{} pixels of {} channels and {} has {}x{} of {}: barycenters are taken frequency by frequency, so "
        "crop or resample them to one size",
        problem.exemplar.name, a.width, a.height, problem.exemplar.pixels.channels(), problem.second->name, b.width,
        b.height, problem.second->pixels.channels());
  }
  support_of(params, a);  // throws with the reason
  return refuse_spline_noise(domain);
}

std::unique_ptr<Model> fit_mixing(const Problem& problem, const Params& params, Seed seed) {
  if (problem.second == nullptr) {
    throw std::invalid_argument(std::string(second_missing));
  }
  require_usable(problem.exemplar);
  require_usable(*problem.second);
  const SotOptions fit = fit_options(params);
  const GaussianModel first = fit_spot(problem.exemplar, fit.component);
  const GaussianModel second = fit_spot(*problem.second, fit.component);
  const Support support = support_of(params, problem.exemplar.pixels.extent());
  const int kernels = static_cast<int>(params.integer("kernels"));

  SplineTexton texton{.coefficients = {.kernels = std::vector<Image>(static_cast<std::size_t>(kernels)),
                                       .support_pixels = support.pixels,
                                       .mean = std::vector<double>(first.mean.size(), 0.0)},
                      .order = fit.projections.order,
                      .support_area = spline_support_area(support, fit.projections.order)};
  parallel_for(kernels, [&](int k) {
    const GaussianModel between = barycenter(first, second, k / (kernels - 1.0));
    texton.coefficients.kernels[static_cast<std::size_t>(k)] =
        std::move(fit_sot(between, support, fit, seed).texton.kernels.front());
  });

  const PlaneShare share = share_of(params);
  SplineNoiseOptions noise = spline_noise_options(params);
  noise.share = share;
  return std::make_unique<Mixture>(make_spline_noise(std::move(texton), noise), share, first.mean, second.mean);
}

}  // namespace

MethodEntry mixing_entry() {
  return {.name = "mixing",
          .title = "Mixture of two textures",
          .reference = "Galerne, Leclaire, Moisan, CGF 2017, Section 7",
          .params = mixing_params(),
          .refuses = refuse_mixing,
          .analyze = fit_mixing};
}

}  // namespace textonbench
