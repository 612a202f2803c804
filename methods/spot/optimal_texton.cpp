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
#include "methods/spot/spline_spectrum.h"
#include "methods/spot/spot_noise.h"
#include "methods/spot/support.h"
#include "methods/spot/texton_mix.h"

namespace textonbench {
namespace {

TransportObjective objective_of(const GaussianModel& model, const Image& mask, int order) {
  if (model.spectrum.factors.size() != 1) {
    throw std::invalid_argument(
        fmt::format("optimal textons of a Gaussian model of rank {}: expected rank 1", model.spectrum.factors.size()));
  }
  return TransportObjective(model.spectrum.factors.front(), mask, order);
}

/// (A − B) / tr B, A the color covariance of kernels, or of coefficients of that order, laid out as for
/// TransportObjective::evaluate.
class ColorResidual {
 public:
  ColorResidual(const GaussianModel& model, const SupportPlane& support, int order)
      : support_(support), order_(order), wanted_(color_covariance(model.spectrum)), scale_(wanted_.trace()) {}

  Eigen::MatrixXd operator()(std::span<const double> kernels) const {
    Eigen::MatrixXd sum = -wanted_;
    for (std::size_t first = 0; first < kernels.size(); first += support_.size()) {
      const std::span<const double> kernel = kernels.subspan(first, support_.size());
      sum += as_columns(kernel).transpose() * as_columns(overlap(kernel));
    }
    return (sum + sum.transpose()) / (2 * scale_);
  }

  /// Adds the gradient of ⟨weights, residual⟩, for symmetric weights.
  void add_gradient(std::span<const double> kernels, const Eigen::MatrixXd& weights, std::span<double> gradient) const {
    for (std::size_t first = 0; first < kernels.size(); first += support_.size()) {
      Eigen::Map<Eigen::MatrixXd>(gradient.data() + first, support_.pixels(), support_.channels()) +=
          2 / scale_ * (as_columns(overlap(kernels.subspan(first, support_.size()))) * weights);
    }
  }

 private:
  using Columns = Eigen::Map<const Eigen::MatrixXd>;

  Columns as_columns(std::span<const double> kernel) const {
    return {kernel.data(), support_.pixels(), support_.channels()};
  }

  /// b * α on the support: at order 0 the kernel as it is, in double precision.
  std::vector<double> overlap(std::span<const double> kernel) const {
    std::vector<double> result(kernel.begin(), kernel.end());
    if (order_ > 0) {
      Image image(support_.box(), support_.channels());
      support_.scatter(kernel, image);
      support_.gather(spline_overlap(image, order_), 1, result);
    }
    return result;
  }

  const SupportPlane& support_;
  int order_;
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
    all.push_back(constrainable_color_correction_param());
    std::ranges::copy(support_params(31), std::back_inserter(all));
    std::ranges::copy(spot_noise_params("gaussian"), std::back_inserter(all));
    return all;
  }();
  return specs;
}

std::optional<std::string> refuse_optimal_texton(const Problem& problem, const Params& params, const Domain& domain) {
  return refuse_spot_noise(support_of(params, problem.exemplar.pixels.extent()).box, domain);
}

std::unique_ptr<Model> analyze_optimal_texton(const Problem& problem, const Params& params, Seed seed) {
  const GaussianModel model = fit_spot(problem.exemplar, component_of(params));
  const Support support = support_of(params, problem.exemplar.pixels.extent());
  OptimalTexton fitted = fit_optimal_texton(model, support_image(support),
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
  const TransportObjective objective = objective_of(model, mask, options.order);
  std::vector<double> x;
  LbfgsSummary summary = minimize_error(objective, options, seed, x);
  if (options.keep_color_covariance) {
    LbfgsSummary constrained =
        minimize_constrained(objective, {model, objective.support(), options.order}, options.evaluations, x);
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
    CorrectedTexton exact =
        correct_colors(std::move(result.texton), model.spectrum, ColorCorrection::transport, options.order);
    result.texton = std::move(exact.texton);
    result.rme = exact.rme_after;
  }
  return result;
}

TextonBound bound_texton_error(const GaussianModel& model, const Image& mask, const TextonBoundOptions& options,
                               Seed seed) {
  if (options.proof.order != 0) {
    throw std::invalid_argument(
        fmt::format("bound on textons of B-spline order {}: expected order 0", options.proof.order));
  }
  const TransportObjective objective = objective_of(model, mask, 0);
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
