#include "methods/spot/texton_noise.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "methods/base/bspline.h"

namespace textonbench {
namespace {

std::span<const ParamSpec> texton_noise_params() {
  static const std::vector<ParamSpec> specs = [] {
    std::vector<ParamSpec> all = texton_fit_params();
    std::ranges::copy(spline_noise_params(), std::back_inserter(all));
    return all;
  }();
  return specs;
}

TextonNoiseOptions texton_noise_options(const Params& params) {
  TextonNoiseOptions options{.component = component_of(params),
                             .order = static_cast<int>(params.integer("order")),
                             .fit = params.text("fit") == "direct" ? TextonFit::direct : TextonFit::projections,
                             .start = sot_start_of(params),
                             .projections = projection_options(params)};
  options.direct.kernels = static_cast<int>(params.integer("kernels"));
  options.direct.evaluations = static_cast<int>(params.integer("evaluations"));
  options.direct.keep_color_covariance = params.text("color_correction") == "constrained";
  if (!options.direct.keep_color_covariance) {
    options.color_correction = color_correction_of(params);
  }
  return options;
}

/// What only the direct fit can do.
std::optional<std::string> refuse_projections(const TextonNoiseOptions& options) {
  if (options.fit == TextonFit::direct) {
    return std::nullopt;
  }
  if (options.direct.kernels > 1) {
    return fmt::format("kernels = {}: alternating projections fit one texton; expected 1, or fit = direct",
                       options.direct.kernels);
  }
  if (options.direct.keep_color_covariance) {
    return "color_correction = constrained: alternating projections take no constraint; expected none, authors or "
           "transport, or fit = direct";
  }
  return std::nullopt;
}

std::optional<std::string> refuse_texton_noise(const Problem& problem, const Params& params, const Domain& domain) {
  if (auto reason = refuse_texton_fit(problem, params)) {
    return reason;
  }
  if (domain.step != 1 && params.text("route") != "auto" && params.text("route") != "points") {
    return fmt::format("route = {} draws rasters of step 1, and a step of {} was asked for; expected auto or points",
                       params.text("route"), domain.step);
  }
  return refuse_spline_noise(domain);
}

ImpactProcess impact_process_named(const std::string& name) {
  return name == "poisson"          ? ImpactProcess::poisson
         : name == "signed_poisson" ? ImpactProcess::signed_poisson
         : name == "stratified"     ? ImpactProcess::stratified
                                    : ImpactProcess::paper;
}

SplineRoute spline_route_named(const std::string& name) {
  return name == "auto"      ? SplineRoute::automatic
         : name == "points"  ? SplineRoute::points
         : name == "impacts" ? SplineRoute::impacts
                             : SplineRoute::convolution;
}

Texton fit_direct(const Exemplar& exemplar, const Support& support, const TextonNoiseOptions& options, Seed seed) {
  const GaussianModel model = fit_spot(exemplar, options.component);
  OptimalTextonOptions direct = options.direct;
  direct.order = options.order;
  Texton texton = fit_optimal_texton(model, support_image(support), direct, seed).texton;
  return options.color_correction == ColorCorrection::none
             ? std::move(texton)
             : correct_colors(std::move(texton), model.spectrum, options.color_correction, options.order).texton;
}

Texton fit_by_projections(const Exemplar& exemplar, const Support& support, const TextonNoiseOptions& options,
                          Seed seed) {
  SotOptions sot{.component = options.component,
                 .start = options.start,
                 .projections = options.projections,
                 .color_correction = options.color_correction};
  sot.projections.order = options.order;
  return fit_sot(exemplar, support, sot, seed).texton;
}

}  // namespace

SplineTexton fit_texton_noise(const Exemplar& exemplar, const Support& support, const TextonNoiseOptions& options,
                              Seed seed) {
  if (const auto reason = refuse_projections(options)) {
    throw std::invalid_argument(*reason);
  }
  return {.coefficients = options.fit == TextonFit::direct ? fit_direct(exemplar, support, options, seed)
                                                           : fit_by_projections(exemplar, support, options, seed),
          .order = options.order,
          .support_area = spline_support_area(support, options.order)};
}

ParamSpec spline_order_param() {
  return {.name = "order",
          .default_value = std::int64_t{1},
          .unit = "",
          .help = "of the B-splines that the texton is made of; the noise has order − 1 continuous derivatives",
          .min = 0,
          .max = max_bspline_order};
}

std::vector<ParamSpec> texton_fit_params() {
  std::vector<ParamSpec> all = support_params(31);
  all.push_back(spline_order_param());
  all.push_back({.name = "fit",
                 .default_value = std::string("projections"),
                 .unit = "",
                 .help = "projections: one texton by the paper's alternating projections; direct: textons that "
                         "minimize the model error",
                 .choices = {"projections", "direct"}});
  std::ranges::copy(projection_params(), std::back_inserter(all));
  all.push_back({.name = "kernels",
                 .default_value = std::int64_t{1},
                 .unit = "",
                 .help = "number of textons, of which each impact takes one at the same cost a pixel; more than one "
                         "with fit = direct",
                 .min = 1,
                 .max = 64});
  all.push_back({.name = "evaluations",
                 .default_value = std::int64_t{OptimalTextonOptions{}.evaluations},
                 .unit = "",
                 .help = "evaluations of the model error and its gradient that fit = direct may take",
                 .min = 1,
                 .max = 1e6});
  all.push_back(constrainable_color_correction_param());
  all.push_back(component_param());
  return all;
}

std::optional<std::string> refuse_texton_fit(const Problem& problem, const Params& params) {
  support_of(params, problem.exemplar.pixels.extent());  // throws with the reason
  return refuse_projections(texton_noise_options(params));
}

SplineTexton fit_texton_noise(const Exemplar& exemplar, const Params& params, Seed seed) {
  return fit_texton_noise(exemplar, support_of(params, exemplar.pixels.extent()), texton_noise_options(params), seed);
}

std::vector<ParamSpec> spline_impacts_params() {
  return {{.name = "impacts",
           .default_value = std::string("stratified"),
           .unit = "",
           .help = "where kernels fall: one of random sign in each cell of a lattice (stratified); at the points of a "
                   "Poisson process, which takes several times as many to look as Gaussian, all of weight 1 (poisson) "
                   "or of random sign (signed_poisson); or as the paper's shader draws them, with its defects",
           .choices = {"poisson", "signed_poisson", "stratified", "paper"}},
          {.name = "mni",
           .default_value = 5.0,
           .unit = "impact",
           .help = "mean number of impacts that cover a point; the paper takes 30 of poisson impacts",
           .min = 1e-6,
           .max = 1e6},
          {.name = "cell",
           .default_value = 0.0,
           .unit = "support side",
           .help = "side of the cells that poisson and paper impacts are drawn by; 0: the fastest, 0.6 for paper",
           .min = 0,
           .max = 16}};
}

SplineNoiseOptions spline_impacts_options(const Params& params) {
  return {.impacts = impact_process_named(params.text("impacts")),
          .mni = params.number("mni"),
          .cell = params.number("cell")};
}

std::vector<ParamSpec> spline_noise_params() {
  std::vector<ParamSpec> all = spline_impacts_params();
  all.push_back({.name = "route",
                 .default_value = std::string("auto"),
                 .unit = "",
                 .help = "how a raster is computed: point by point (any step), row by row of each impact, by Fourier "
                         "transform of the impacts (convolution), or the fastest of them",
                 .choices = {"auto", "points", "impacts", "convolution"}});
  return all;
}

SplineNoiseOptions spline_noise_options(const Params& params) {
  SplineNoiseOptions options = spline_impacts_options(params);
  options.route = spline_route_named(params.text("route"));
  return options;
}

MethodEntry texton_noise_entry() {
  return {.name = "texton_noise",
          .title = "Texton noise",
          .reference = "Galerne, Leclaire, Moisan, CGF 2017",
          .params = texton_noise_params(),
          .refuses = refuse_texton_noise,
          .analyze = [](const Problem& problem, const Params& params, Seed seed) {
            require_usable(problem.exemplar);
            return make_spline_noise(fit_texton_noise(problem.exemplar, params, seed), spline_noise_options(params));
          }};
}

}  // namespace textonbench
