#include "methods/spot/sot.h"

#include "methods/spot/spot_noise.h"

namespace textonbench {
namespace {

std::span<const ParamSpec> sot_params() {
  static const std::vector<ParamSpec> specs = [] {
    const SotOptions defaults;
    std::vector<ParamSpec> all = support_params(31);
    all.push_back({.name = "iterations",
                   .default_value = std::int64_t{defaults.projections.iterations},
                   .unit = "",
                   .help = "alternating projections, at most",
                   .min = 1,
                   .max = 1e6});
    all.push_back({.name = "tolerance",
                   .default_value = defaults.projections.tolerance,
                   .unit = "",
                   .help = "stop once an iteration lowers the model error by no more than this part of it; 0: never",
                   .min = 0,
                   .max = 0.5});
    all.push_back({.name = "initialization",
                   .default_value = std::string("random_phase"),
                   .unit = "",
                   .help = "random_phase: the spot with random phases; white: white noise in every channel",
                   .choices = {"random_phase", "white"}});
    all.push_back(color_correction_param());
    all.push_back(component_param());
    const std::vector<ParamSpec> noise = spot_noise_params("gaussian");
    all.insert(all.end(), noise.begin(), noise.end());
    return all;
  }();
  return specs;
}

SotOptions options_of(const Params& params) {
  return {.component = component_of(params),
          .start = params.text("initialization") == "white" ? SotStart::white : SotStart::random_phase,
          .projections = {.iterations = static_cast<int>(params.integer("iterations")),
                          .tolerance = params.number("tolerance")},
          .color_correction = color_correction_of(params)};
}

}  // namespace

ProjectedTexton fit_sot(const Exemplar& exemplar, const Support& support, const SotOptions& options, Seed seed) {
  const GaussianModel model = fit_spot(exemplar, options.component);
  const Spectrum& spot = model.spectrum.factors.front();
  const Spectrum start = options.start == SotStart::white ? white_start(spot, seed) : random_phase_start(spot, seed);
  ProjectedTexton result = alternate_projections(model, support, start, options.projections);
  if (options.color_correction != ColorCorrection::none) {
    result.texton = correct_colors(std::move(result.texton), model.spectrum, options.color_correction).texton;
  }
  return result;
}

MethodEntry sot_entry() {
  return {.name = "sot",
          .title = "Synthesis-oriented texton",
          .reference = "Galerne, Leclaire, Moisan, EUSIPCO 2014",
          .params = sot_params(),
          .refuses =
              [](const Problem& problem, const Params& params, const Domain& domain) {
                return refuse_spot_noise(support_of(params, problem.exemplar.pixels.extent()).box, domain);
              },
          .analyze =
              [](const Problem& problem, const Params& params, Seed seed) {
                require_usable(problem.exemplar);
                const Support support = support_of(params, problem.exemplar.pixels.extent());
                ProjectedTexton fitted = fit_sot(problem.exemplar, support, options_of(params), seed);
                const bool tolerable = fitted.summary.stop == ProjectionSummary::Stop::tolerance;
                return make_spot_noise(std::move(fitted.texton), spot_noise_options(params, support.pixels),
                                       Convergence{.step = "iteration",
                                                   .rme = std::move(fitted.summary.rme),
                                                   .reason = tolerable ? "tolerance" : "iterations"});
              }};
}

}  // namespace textonbench
