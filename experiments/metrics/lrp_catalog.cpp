#include "experiments/metrics/lrp_catalog.h"

#include <array>

#include "experiments/metrics/lrp_identities.h"

namespace textonbench {
namespace {

constexpr MetricEntry lrp_row(std::string_view name, std::string_view title,
                              std::optional<double> (*of_model)(const Model&, const Target&, const Domain&),
                              std::string_view reference, Better better = Better::neither) {
  return {.name = name,
          .title = title,
          .unit = "1",
          .level = MetricLevel::model,
          .better = better,
          .reference = reference,
          .source = "lrp_identities",
          .of_model = of_model,
          .identity = true};
}

}  // namespace

std::span<const MetricEntry> lrp_metrics() {
  static constexpr std::array entries{
      lrp_row("lrp_least_windows", "Least number of windows at a point", lrp_least_windows,
              "windows that are not zero"),
      lrp_row("lrp_most_windows", "Greatest number of windows at a point", lrp_most_windows,
              "windows that are not zero"),
      lrp_row("lrp_envelope_ripple", "Variation of the envelope over a cell", lrp_envelope_ripple,
              "(max − min) / mean of Σ w", Better::lower),
      lrp_row("lrp_variance_ripple", "Variation of the variance over a cell", lrp_variance_ripple,
              "(max − min) / mean of Σ v², v the windows as scaled", Better::lower),
      lrp_row("lrp_leakage_exponent", "Exponent of the leakage", lrp_leakage_exponent,
              "log2 of the ratio of 75 % radii at Δ = 12 and 6"),
      lrp_row("lrp_window_error", "Window against the converged one", lrp_window_error, "largest |w − w of I₃|",
              Better::lower),
      lrp_row("lrp_five_terms_error", "Five terms of I₃ against the converged window", lrp_five_terms_error,
              "largest difference"),
      lrp_row("lrp_concentration_ratio", "Energy off the main lobe against a cut Gaussian's", lrp_concentration_ratio,
              "of equal 75 % radius"),
      lrp_row("lrp_radial_energy", "∫ r w² dr", lrp_radial_energy, "by quadrature"),
      lrp_row("lrp_stratum_variance_error", "Variance of layers against strata", lrp_stratum_variance_error,
              "largest relative difference, in closed form", Better::lower),
      lrp_row("lrp_strata_imbalance", "Energy of strata against equal shares", lrp_strata_imbalance,
              "largest difference over the largest bin", Better::lower),
      lrp_row("lrp_erosion_energy", "Energy of a window within the erosion", lrp_erosion_energy,
              "∫ |ŵ|² over [−δ, δ] / ∫ |ŵ|²"),
      lrp_row("lrp_coverage", "Coverage of strata by windows", lrp_coverage,
              "noise-equivalent areas over that of the stratum, half plane"),
      lrp_row("lrp_calls", "Windows and cosines a point", lrp_calls, "counted", Better::lower),
      lrp_row("lrp_calls_ratio", "Windows and cosines over 9 (J + s)", lrp_calls_ratio, "counted")};
  return entries;
}

}  // namespace textonbench
