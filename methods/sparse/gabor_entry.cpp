#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "methods/base/gaussian_model.h"
#include "methods/sparse/gabor.h"
#include "methods/sparse/gabor_filter.h"

namespace textonbench {
namespace {

GaborOptions gabor_options(const Params& params) {
  GaborOptions options;
  options.frequency = params.number("frequency");
  options.orientation = params.number("orientation");
  options.directions = static_cast<int>(params.integer("directions"));
  options.bandwidth = params.number("bandwidth");
  options.cut = params.number("cut");
  options.mni = params.number("mni");
  options.process = params.text("impacts") == "stratified"       ? ImpactProcess::stratified
                    : params.text("impacts") == "signed_poisson" ? ImpactProcess::signed_poisson
                                                                 : ImpactProcess::poisson;
  options.phase = params.text("phase") == "random"   ? GaborPhase::random
                  : params.text("phase") == "cosine" ? GaborPhase::cosine
                                                     : GaborPhase::sine;
  options.weight = params.text("weights") == "uniform" ? GaborWeight::uniform : GaborWeight::impacts;
  return options;
}

/// Kernels of each axis of the exemplar's colors, as often as its part of the variance.
std::unique_ptr<Model> analyze_gabor(const Problem& problem, const Params& params, Seed) {
  require_usable(problem.exemplar);
  const GaussianModel colors = gaussian_model(problem.exemplar.pixels);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(color_covariance(colors.spectrum));
  const Eigen::VectorXd variance = axes.eigenvalues().cwiseMax(0);
  const auto deviation = static_cast<float>(std::sqrt(variance.sum()));
  GaborField field = gabor_field(gabor_options(params));
  field.channels = problem.exemplar.pixels.channels();
  GaborBand& band = field.bands.front();
  const std::vector<GaborFrequency> directions = std::move(band.frequency);
  const std::complex<float> amplitude = deviation * band.color.front();
  band.frequency.clear(), band.color.clear();
  std::vector<double> weights;
  for (int axis = field.channels - 1; axis >= 0; --axis) {
    if (variance[axis] <= 1e-12 * variance.sum()) continue;
    for (const GaborFrequency& direction : directions) {
      band.frequency.push_back(direction);
      weights.push_back(variance[axis]);
      for (int c = 0; c < field.channels; ++c) {
        band.color.push_back(amplitude * static_cast<float>(axes.eigenvectors()(c, axis)));
      }
    }
  }
  band.draw_by(weights);
  return make_gabor(filtered_gabor(field, params.number("footprint")), colors.mean);
}

std::span<const ParamSpec> gabor_params() {
  static const std::vector<ParamSpec> specs = {
      {.name = "frequency",
       .default_value = 0.1,
       .unit = "1/pixel",
       .help = "of all kernels, cycles a pixel",
       .min = 0,
       .max = 1},
      {.name = "orientation",
       .default_value = 0.0,
       .unit = "degree",
       .help = "of the first wave vector, from the x axis towards the y axis",
       .min = -360,
       .max = 360},
      {.name = "directions",
       .default_value = std::int64_t{64},
       .unit = "",
       .help = "of the wave vectors, evenly spread over half a turn: 1 is anisotropic noise, many are isotropic",
       .min = 1,
       .max = 4096},
      {.name = "bandwidth",
       .default_value = 0.05,
       .unit = "1/pixel",
       .help = "a of the kernels' windows exp(-pi a^2 r^2); their spectra have the standard deviation a / 2 sqrt(pi)",
       .min = 0.001,
       .max = 1},
      {.name = "cut",
       .default_value = 0.01,
       .unit = "",
       .help = "value of the window where it ends; the paper's code has 0.05",
       .min = 1e-6,
       .max = 0.5},
      {.name = "mni",
       .default_value = 10.0,
       .unit = "impact",
       .help = "mean number of impacts that reach a point",
       .min = 0.01,
       .max = 1000},
      {.name = "impacts",
       .default_value = std::string("stratified"),
       .unit = "",
       .help =
           "stratified: one in each cell, of random sign; signed_poisson: a Poisson process of random signs; poisson: "
           "of weight 1, as in the paper",
       .choices = {"stratified", "signed_poisson", "poisson"}},
      {.name = "phase",
       .default_value = std::string("random"),
       .unit = "",
       .help = "of the kernels: random, or cosine or sine for all",
       .choices = {"random", "cosine", "sine"}},
      {.name = "weights",
       .default_value = std::string("impacts"),
       .unit = "",
       .help = "impacts: those of the impacts; uniform: times uniform numbers between -1 and 1, as in the paper",
       .choices = {"impacts", "uniform"}},
      footprint_param()};
  return specs;
}

}  // namespace

MethodEntry gabor_entry() {
  return {.name = "gabor",
          .title = "Gabor noise",
          .reference = "Lagae, Lefebvre, Drettakis, Dutré, SIGGRAPH 2009; Tavernier et al., Eurographics 2019",
          .params = gabor_params(),
          .refuses = [](const Problem&, const Params& params, const Domain& domain) -> std::optional<std::string> {
            if (auto reason = refuse_gabor_domain(domain)) return reason;
            const GaborOptions options = gabor_options(params);
            if (auto reason = refuse_gabor(options)) return reason;
            return refuse_footprint(GaborWindow::round(options.bandwidth, options.cut), params.number("footprint"));
          },
          .analyze = analyze_gabor};
}

}  // namespace textonbench
