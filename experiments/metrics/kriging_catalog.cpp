#include "experiments/metrics/kriging_catalog.h"

#include <array>

#include "experiments/metrics/conditional_law.h"
#include "experiments/metrics/kriging_metrics.h"

namespace textonbench {
namespace {

using KrigingOfModel = std::optional<double> (*)(const Model&, const Target&, const Domain&);

constexpr MetricEntry solution_row(std::string_view name, std::string_view title, std::string_view unit,
                                   KrigingOfModel of_model, std::string_view reference) {
  return {.name = name,
          .title = title,
          .unit = unit,
          .level = MetricLevel::model,
          .better = Better::lower,
          .reference = reference,
          .source = "kriging_metrics",
          .of_model = of_model,
          .identity = true};
}

constexpr MetricEntry law_row(std::string_view name, std::string_view title, std::string_view unit, Better better,
                              KrigingOfModel of_model, std::string_view reference) {
  return {.name = name,
          .title = title,
          .unit = unit,
          .level = MetricLevel::model,
          .better = better,
          .reference = reference,
          .source = "conditional_law",
          .of_model = of_model,
          .identity = true};
}

}  // namespace

std::span<const MetricEntry> kriging_metrics() {
  static constexpr std::array entries{
      solution_row("kriging_residual", "Residual of the kriging system", "1", kriging_residual,
                   "true ‖φ − Γ k‖ / ‖φ‖, φ = (u − m)_C"),
      solution_row("kriging_iterations", "Iterations of the kriging system", "iteration", kriging_iterations,
                   "until the tolerance or the limit; 0 of a dense solution"),
      solution_row("kriging_unknowns", "Unknowns of the kriging system", "1", kriging_unknowns,
                   "conditioning pixels x channels"),
      solution_row("kriging_setup_seconds", "Set-up time of the kriging system", "s", kriging_setup_seconds,
                   "wall time of factors, once for all samples"),
      solution_row("kriging_solve_seconds", "Solution time of the kriging system", "s", kriging_solve_seconds,
                   "wall time of one solution"),
      solution_row("kriging_iteration_seconds", "Time of an iteration", "s", kriging_iteration_seconds,
                   "median wall time of the iterations of one solution"),
      solution_row("kriging_bytes", "Memory of the solver", "byte", kriging_bytes,
                   "bytes of the dense matrix or of the preconditioner"),
      solution_row("kriging_error", "Error of the kriging component", "sd", kriging_error,
                   "rms difference from the dense solution over the missing pixels / standard deviation of the model"),
      solution_row("kriging_condition_number", "Condition number of the kriging system", "1", kriging_condition_number,
                   "largest / least eigenvalue of Γ_CC, by power iteration"),
      law_row("kriging_border_distance", "Kriging component against a border of 20", "sd", Better::lower,
              kriging_border_distance, "rms difference over the missing pixels / standard deviation of the model"),
      law_row("kriging_variance_ratio", "Conditional variance against a border of 10", "1", Better::lower,
              kriging_variance_ratio, "mean conditional variance of some 50 missing pixels / that with a border of 10"),
      law_row("conditional_mean_deviation", "Mean of conditional samples", "1", Better::nearer_zero,
              conditional_mean_deviation,
              "Mahalanobis distance of 2000 samples' mean from the dense one, as a standard normal number"),
      law_row("conditional_covariance_deviation", "Covariance of conditional samples", "1", Better::nearer_zero,
              conditional_covariance_deviation,
              "sum of squared Mahalanobis distances of 2000 samples, as a standard normal number"),
      law_row("kriging_innovation_correlation", "Correlation of kriging component and innovation", "1", Better::lower,
              kriging_innovation_correlation, "largest |correlation| x √2000 over pairs of values"),
      law_row("hole_covariance_ratio", "Covariance across the edge of the hole", "1", Better::lower,
              hole_covariance_ratio,
              "rms error of the covariance of missing and known pixels, 8 <= |v|∞ <= 32 / that of free samples"),
      law_row("estimate_bias", "Bias of the estimate from masked data", "1", Better::lower, estimate_bias,
              "sqrt(Σ ‖Γ − Γ'‖² / Σ ‖Γ‖²), |v|∞ <= 8, from all and from the known pixels"),
  };
  return entries;
}

}  // namespace textonbench
