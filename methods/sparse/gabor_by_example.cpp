#include <fmt/format.h>

#include <stdexcept>

#include "methods/sparse/gabor.h"
#include "methods/sparse/gabor_filter.h"
#include "methods/sparse/gabor_fit.h"

namespace textonbench {
namespace {

GaborFit fit_by_example(const GaborTarget& target, const Params& params) {
  GaborFit pursuit =
      fit_pursuit(target,
                  {.bands = static_cast<int>(params.integer("bands")),
                   .finest = params.number("finest"),
                   .ratio = params.number("ratio"),
                   .cut = params.number("cut")},
                  {.residual = params.text("residual") == "power" ? PursuitResidual::power : PursuitResidual::transport,
                   .noise = params.number("noise"),
                   .iterations = static_cast<int>(params.integer("iterations"))});
  if (pursuit.reason == "iterations" && !params.boolean("force")) {
    throw std::runtime_error(fmt::format(
        "gabor_by_example: no convergence within {} iterations, the residual is {:.3g} times that of noise; "
        "expected {} times. Give more iterations or more noise, or take the model as it is by force = true",
        pursuit.rme.size() - 1, pursuit.residual, params.number("noise")));
  }
  if (params.text("fitter") == "pursuit") return pursuit;
  GaborFit mixture = fit_mixture(target, pursuit,
                                 {.kernels = static_cast<int>(params.integer("kernels")),
                                  .iterations = static_cast<int>(params.integer("polishing"))});
  if (mixture.reason == "iterations" && !params.boolean("force")) {
    throw std::runtime_error(
        fmt::format("gabor_by_example: no convergence within {} polishing iterations. Give more, or take the model as "
                    "it is by force = true",
                    params.integer("polishing")));
  }
  return mixture;
}

std::unique_ptr<Model> analyze_gabor_by_example(const Problem& problem, const Params& params, Seed) {
  const GaborTarget target = gabor_target(problem.exemplar, static_cast<int>(params.integer("side")));
  GaborFit fit = fit_by_example(target, params);
  const std::string& impacts = params.text("impacts");
  const GaborField field = fitted_field(fit, target.channels(),
                                        {.mni = params.number("mni"),
                                         .process = impacts == "stratified"       ? ImpactProcess::stratified
                                                    : impacts == "signed_poisson" ? ImpactProcess::signed_poisson
                                                                                  : ImpactProcess::poisson,
                                         .axes = params.text("colors") == "axes"});
  return make_gabor(filtered_gabor(field, params.number("footprint")), target.mean,
                    Convergence{.step = "iteration", .rme = std::move(fit.rme), .reason = fit.reason});
}

std::optional<std::string> refuse_by_example(const Problem& problem, const Params& params, const Domain& domain) {
  if (auto reason = refuse_gabor_domain(domain)) return reason;
  const Extent size = problem.exemplar.pixels.extent();
  const Extent raster = gabor_raster(size, static_cast<int>(params.integer("side")));
  const std::vector<GaborWindow> windows = band_windows(raster, {.bands = static_cast<int>(params.integer("bands")),
                                                                 .finest = params.number("finest"),
                                                                 .ratio = params.number("ratio"),
                                                                 .cut = params.number("cut")});
  if (windows.empty() || windows.front().half_width() > 512) {
    return fmt::format(
        "gabor_by_example with kernels of a radius of {:.3g} pixels: expected 1 to 512; a larger finest or "
        "cut makes them smaller",
        windows.empty() ? 0 : windows.front().half_width());
  }
  return refuse_footprint(windows.front(), params.number("footprint"));
}

std::span<const ParamSpec> by_example_params() {
  static const std::vector<ParamSpec> specs = {
      {.name = "fitter",
       .default_value = std::string("pursuit"),
       .unit = "",
       .help = "pursuit: kernels of a few round windows, as in the paper; mixture: these merged into few, each with an "
               "elliptic window of its own, and polished",
       .choices = {"pursuit", "mixture"}},
      {.name = "residual",
       .default_value = std::string("transport"),
       .unit = "",
       .help = "what the pursuit makes small: transport, the optimal-transport distance of the powers; power, the sum "
               "of squares of their differences, as in the paper",
       .choices = {"transport", "power"}},
      {.name = "noise",
       .default_value = 1.0,
       .unit = "",
       .help = "residual that is left, as a part of what chance makes of a periodogram's bins: less needs more kernels",
       .min = 0.05,
       .max = 100},
      {.name = "bands",
       .default_value = std::int64_t{6},
       .unit = "",
       .help = "windows at most; those of a radius below a pixel are left out",
       .min = 1,
       .max = 8},
      {.name = "finest",
       .default_value = 0.5,
       .unit = "bin",
       .help = "standard deviation of the spectrum of the widest window, bins of the exemplar's spectrum",
       .min = 0.1,
       .max = 64},
      {.name = "ratio",
       .default_value = 2.0,
       .unit = "",
       .help = "of a window's bandwidth to the one before",
       .min = 1.05,
       .max = 8},
      {.name = "kernels",
       .default_value = std::int64_t{24},
       .unit = "kernel",
       .help = "of a mixture, at most",
       .min = 1,
       .max = 256},
      {.name = "colors",
       .default_value = std::string("vectors"),
       .unit = "",
       .help = "vectors: of each kernel, with the phases between channels; axes: those that decorrelate the channels",
       .choices = {"vectors", "axes"}},
      {.name = "mni",
       .default_value = 40.0,
       .unit = "impact",
       .help = "mean number of impacts at a point",
       .min = 0.1,
       .max = 1000},
      {.name = "impacts",
       .default_value = std::string("stratified"),
       .unit = "",
       .help = "stratified: one in each cell, of random sign; signed_poisson: a Poisson process of random signs; "
               "poisson: of weight 1, as in the paper",
       .choices = {"stratified", "signed_poisson", "poisson"}},
      {.name = "cut",
       .default_value = 0.01,
       .unit = "",
       .help = "value of a window where it ends",
       .min = 1e-4,
       .max = 0.5},
      {.name = "side",
       .default_value = std::int64_t{256},
       .unit = "pixel",
       .help = "larger exemplars are analyzed by blocks of at most this side",
       .min = 32,
       .max = 4096},
      {.name = "iterations",
       .default_value = std::int64_t{4000},
       .unit = "iteration",
       .help = "of the pursuit, at most",
       .min = 1,
       .max = 100000},
      {.name = "polishing",
       .default_value = std::int64_t{100},
       .unit = "iteration",
       .help = "of the mixture, at most",
       .min = 1,
       .max = 10000},
      footprint_param(),
      {.name = "force",
       .default_value = false,
       .unit = "",
       .help = "take the fit as it is after all iterations, converged or not"}};
  return specs;
}

}  // namespace

MethodEntry gabor_by_example_entry() {
  return {.name = "gabor_by_example",
          .title = "Gabor noise by example",
          .reference = "Galerne, Lagae, Lefebvre, Drettakis, SIGGRAPH 2012",
          .params = by_example_params(),
          .refuses = refuse_by_example,
          .analyze = analyze_gabor_by_example};
}

}  // namespace textonbench
