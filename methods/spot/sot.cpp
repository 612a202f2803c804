#include "methods/spot/sot.h"

#include "methods/spot/spot_noise.h"

namespace textonbench {
namespace {

std::span<const ParamSpec> sot_params() {
  static const std::vector<ParamSpec> specs = [] {
    std::vector<ParamSpec> all = support_params(31);
    const std::vector<ParamSpec> projections = projection_params();
    all.insert(all.end(), projections.begin(), projections.end());
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
          .start = sot_start_of(params),
          .projections = projection_options(params),
          .color_correction = color_correction_of(params)};
}

}  // namespace

std::vector<ParamSpec> projection_params() {
  const ProjectionOptions defaults;
  return {{.name = "iterations",
           .default_value = std::int64_t{defaults.iterations},
           .unit = "",
           .help = "alternating projections, at most",
           .min = 1,
           .max = 1e6},
          {.name = "tolerance",
           .default_value = defaults.tolerance,
           .unit = "",
           .help = "stop once an iteration lowers the model error by no more than this part of it; 0: never",
           .min = 0,
           .max = 0.5},
          {.name = "initialization",
           .default_value = std::string("random_phase"),
           .unit = "",
           .help = "random_phase: the spot with random phases; white: white noise in every channel",
           .choices = {"random_phase", "white"}}};
}

ProjectionOptions projection_options(const Params& params) {
  return {.iterations = static_cast<int>(params.integer("iterations")), .tolerance = params.number("tolerance")};
}

SotStart sot_start_of(const Params& params) {
  return params.text("initialization") == "white" ? SotStart::white : SotStart::random_phase;
}

ProjectedTexton fit_sot(const Exemplar& exemplar, const Support& support, const SotOptions& options, Seed seed) {
  return fit_sot(fit_spot(exemplar, options.component), support, options, seed);
}

ProjectedTexton fit_sot(const GaussianModel& model, const Support& support, const SotOptions& options, Seed seed) {
  const Spectrum& spot = model.spectrum.factors.front();
  const Spectrum start = options.start == SotStart::white ? white_start(spot, seed) : random_phase_start(spot, seed);
  ProjectedTexton result = alternate_projections(model, support, start, options.projections);
  if (options.color_correction != ColorCorrection::none) {
    result.texton =
        correct_colors(std::move(result.texton), model.spectrum, options.color_correction, options.projections.order)
            .texton;
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
