#include "methods/spot/optimal_texton.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <stdexcept>

#include "methods/exemplar_spot.h"
#include "methods/spot/color_correction.h"
#include "methods/spot/lbfgs.h"
#include "methods/spot/spot_noise.h"
#include "methods/spot/support.h"
#include "methods/spot/texton_mix.h"

namespace textonbench {
namespace {

TransportObjective objective_of(const GaussianModel& model, const Image& mask) {
  if (model.spectrum.factors.size() != 1) {
    throw std::invalid_argument(
        fmt::format("optimal textons of a Gaussian model of rank {}: expected rank 1", model.spectrum.factors.size()));
  }
  return {model.spectrum.factors.front(), mask};
}

/// (A − B) / tr B, A = Σ_k Σ_x h_k h_kᵀ the color covariance of kernels laid out as for TransportObjective::evaluate.
class ColorResidual {
 public:
  ColorResidual(const GaussianModel& model, const SupportPlane& support)
      : channels_(support.channels()),
        pixels_(support.pixels()),
        wanted_(color_covariance(model.spectrum)),
        scale_(wanted_.trace()) {}

  Eigen::MatrixXd operator()(std::span<const double> kernels) const {
    Eigen::MatrixXd sum = -wanted_;
    for_each_kernel(kernels, [&](std::size_t first) {
      const Eigen::Map<const Eigen::MatrixXd> h(kernels.data() + first, pixels_, channels_);
      sum += h.transpose() * h;
    });
    return sum / scale_;
  }

  /// Adds the gradient of ⟨weights, residual⟩, for symmetric weights.
  void add_gradient(std::span<const double> kernels, const Eigen::MatrixXd& weights, std::span<double> gradient) const {
    for_each_kernel(kernels, [&](std::size_t first) {
      const Eigen::Map<const Eigen::MatrixXd> h(kernels.data() + first, pixels_, channels_);
      Eigen::Map<Eigen::MatrixXd>(gradient.data() + first, pixels_, channels_) += 2 / scale_ * (h * weights);
    });
  }

 private:
  template <class Body>
  void for_each_kernel(std::span<const double> kernels, const Body& body) const {
    const auto size = static_cast<std::size_t>(channels_ * pixels_);
    for (std::size_t first = 0; first < kernels.size(); first += size) body(first);
  }

  Eigen::Index channels_, pixels_;
  Eigen::MatrixXd wanted_;
  double scale_;
};

/// Goes on from x under the constraint of colors. The value of the summary is the relative model error alone.
LbfgsSummary minimize_constrained(const TransportObjective& objective, const ColorResidual& residual, int evaluations,
                                  std::vector<double>& x) {
  constexpr int rounds = 6;
  constexpr double penalty = 8;
  Eigen::MatrixXd multipliers = Eigen::MatrixXd::Zero(objective.support().channels(), objective.support().channels());
  LbfgsSummary total;
  for (int round = 0; round < rounds; ++round) {
    const LbfgsSummary part = minimize_lbfgs(
        [&](std::span<const double> at, std::span<double> gradient) {
          const double error = objective.evaluate(at, gradient);
          total.history.push_back(error);
          const Eigen::MatrixXd c = residual(at);
          residual.add_gradient(at, multipliers + penalty * c, gradient);
          return error + multipliers.cwiseProduct(c).sum() + penalty / 2 * c.squaredNorm();
        },
        {.evaluations = std::max(1, evaluations / rounds), .first_step = objective.projection_step()}, x);
    multipliers += penalty * residual(x);
    total.evaluations += part.evaluations;
    total.reason = part.reason;
  }
  total.gradient.resize(x.size());
  total.value = objective.evaluate(x, total.gradient);
  return total;
}

/// Minimizes from white kernels with the energy of the target, which have a random phase at every frequency. Returns
/// the kernels in `x`.
LbfgsSummary minimize_error(const TransportObjective& objective, const OptimalTextonOptions& options, Seed seed,
                            std::vector<double>& x) {
  if (options.kernels < 1 || options.evaluations < 1) {
    throw std::invalid_argument(fmt::format("{} kernels and {} evaluations: expected at least 1 of each",
                                            options.kernels, options.evaluations));
  }
  x.resize(static_cast<std::size_t>(options.kernels) * objective.support().size());
  RandomSequence random(Stream(seed).child("optimal_texton"));
  const double deviation = std::sqrt(objective.variance() / static_cast<double>(x.size()));
  for (double& v : x) {
    v = deviation * random.normal();
  }
  return minimize_lbfgs(
      [&](std::span<const double> at, std::span<double> gradient) { return objective.evaluate(at, gradient); },
      {.evaluations = options.evaluations, .first_step = objective.projection_step()}, x);
}

std::span<const ParamSpec> optimal_texton_params() {
  static const std::vector<ParamSpec> specs = [] {
    std::vector<ParamSpec> all = {
        component_param(),
        {.name = "kernels",
         .default_value = std::int64_t{4},
         .unit = "",
         .help = "number of textons, of which each impact takes one; more of them approximate better, at the same "
                 "cost a pixel",
         .min = 1,
         .max = 64},
        {.name = "evaluations",
         .default_value = std::int64_t{60},
         .unit = "",
         .help = "evaluations of the model error and its gradient that the fit may take",
         .min = 1,
         .max = 1e6}};
    ParamSpec colors = color_correction_param();
    colors.choices.emplace_back("constrained");
    colors.help =
        "give the noise the exemplar's color covariance: by the authors' map or the one that moves colors least "
        "(transport), afterwards, or while the error is minimized (constrained)";
    all.push_back(std::move(colors));
    std::ranges::copy(support_params(31), std::back_inserter(all));
    std::ranges::copy(spot_noise_params("gaussian"), std::back_inserter(all));
    return all;
  }();
  return specs;
}

Image mask_of(const Support& support) {
  Image mask(support.box, 1);
  auto inside = support.inside.begin();
  for (int y = 0; y < mask.height(); ++y) {
    for (float& v : mask.row(0, y)) {
      v = *inside++ != 0 ? 1.0F : 0.0F;
    }
  }
  return mask;
}

std::optional<std::string> refuse_optimal_texton(const Problem& problem, const Params& params, const Domain& domain) {
  return refuse_spot_noise(support_of(params, problem.exemplar.pixels.extent()).box, domain);
}

std::unique_ptr<Model> analyze_optimal_texton(const Problem& problem, const Params& params, Seed seed) {
  const GaussianModel model = fit_spot(problem.exemplar, component_of(params));
  const Support support = support_of(params, problem.exemplar.pixels.extent());
  OptimalTexton fitted = fit_optimal_texton(model, mask_of(support),
                                            {.kernels = static_cast<int>(params.integer("kernels")),
                                             .evaluations = static_cast<int>(params.integer("evaluations")),
                                             .keep_color_covariance = params.text("color_correction") == "constrained"},
                                            seed);
  if (params.text("color_correction") == "authors" || params.text("color_correction") == "transport") {
    fitted.texton = correct_colors(std::move(fitted.texton), model.spectrum, color_correction_of(params)).texton;
  }
  Convergence convergence{.step = "evaluation", .rme = std::move(fitted.history), .reason = fitted.reason};
  for (double& value : convergence.rme) value = std::sqrt(std::max(0.0, value));
  return make_spot_noise(std::move(fitted.texton), spot_noise_options(params, support.pixels), std::move(convergence));
}

}  // namespace

OptimalTexton fit_optimal_texton(const GaussianModel& model, const Image& mask, const OptimalTextonOptions& options,
                                 Seed seed) {
  const TransportObjective objective = objective_of(model, mask);
  std::vector<double> x;
  LbfgsSummary summary = minimize_error(objective, options, seed, x);
  if (options.keep_color_covariance) {
    LbfgsSummary constrained = minimize_constrained(objective, {model, objective.support()}, options.evaluations, x);
    constrained.evaluations += summary.evaluations;
    constrained.history.insert(constrained.history.begin(), summary.history.begin(), summary.history.end());
    summary = std::move(constrained);
  }

  OptimalTexton result;
  result.rme = std::sqrt(std::max(0.0, summary.value));
  result.stationarity = std::inner_product(x.begin(), x.end(), summary.gradient.begin(), 0.0) / 2;
  result.evaluations = summary.evaluations;
  result.history = std::move(summary.history);
  result.reason = summary.reason;
  mix_textons(x, options.kernels, objective.support().channels());
  result.texton = {objective.images(x), objective.support().pixels(), model.mean};
  if (options.keep_color_covariance) {
    CorrectedTexton exact = correct_colors(std::move(result.texton), model.spectrum, ColorCorrection::transport);
    result.texton = std::move(exact.texton);
    result.rme = exact.rme_after;
  }
  return result;
}

TextonBound bound_texton_error(const GaussianModel& model, const Image& mask, const TextonBoundOptions& options,
                               Seed seed) {
  const TransportObjective objective = objective_of(model, mask);
  std::vector<double> x;
  const LbfgsSummary summary = minimize_error(objective, options.proof, seed, x);
  TextonBound result;
  result.attained = std::sqrt(std::max(0.0, summary.value));
  result.certificate = certify(objective, x, options.certificate, seed);
  result.rme = std::sqrt(result.certificate.bound);
  return result;
}

MethodEntry optimal_texton_entry() {
  return {.name = "optimal_texton",
          .title = "Optimal textons",
          .reference = "our own, after Galerne, Leclaire, Moisan, EUSIPCO 2014, eq. 1",
          .params = optimal_texton_params(),
          .refuses = refuse_optimal_texton,
          .analyze = analyze_optimal_texton};
}

}  // namespace textonbench
