#include "experiments/metrics/lrp_catalog.h"

#include <array>

#include "experiments/metrics/lrp_estimates.h"
#include "experiments/metrics/lrp_identities.h"
#include "experiments/metrics/lrp_structure.h"

namespace textonbench {
namespace {

constexpr MetricEntry lrp_row(std::string_view name, std::string_view title,
                              std::optional<double> (*of_model)(const Model&, const Target&, const Domain&),
                              std::string_view reference, Better better = Better::neither,
                              std::string_view source = "lrp_identities") {
  return {.name = name,
          .title = title,
          .unit = "1",
          .level = MetricLevel::model,
          .better = better,
          .reference = reference,
          .source = source,
          .of_model = of_model,
          .identity = true};
}

constexpr MetricEntry structure_row(std::string_view name, std::string_view title,
                                    std::optional<double> (*of_model)(const Model&, const Target&, const Domain&),
                                    std::string_view reference, Better better = Better::neither) {
  return lrp_row(name, title, of_model, reference, better, "lrp_structure");
}

constexpr MetricEntry estimate_row(std::string_view name, std::string_view title,
                                   std::optional<double> (*of_model)(const Model&, const Target&, const Domain&),
                                   std::string_view reference, Better better = Better::neither) {
  return lrp_row(name, title, of_model, reference, better, "lrp_estimates");
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
      lrp_row("lrp_calls_ratio", "Windows and cosines over 9 (J + s)", lrp_calls_ratio, "counted"),
      structure_row("lrp_copy_error", "Structure against the exemplar's block", lrp_copy_error,
                    "root-mean-square difference over the standard deviation", Better::lower),
      structure_row("lrp_printed_copy_error", "Equation 4 as printed against the exemplar's block",
                    lrp_printed_copy_error, "times the windows' sum"),
      structure_row("lrp_structure_deviation", "Reduced structure against its image", lrp_structure_deviation,
                    "mean |difference|", Better::lower),
      structure_row("lrp_block_side", "Side of blocks", lrp_block_side, "pixels"),
      structure_row("lrp_table_entries", "Frequencies kept", lrp_table_entries, "of noise and structure",
                    Better::lower),
      structure_row("lrp_distortion_jump", "Jump of the turbulence at borders of blocks", lrp_distortion_jump,
                    "root-mean-square over 2^-10 pixel, σ", Better::lower),
      structure_row("lrp_swapped_distortion_jump", "The same with turbulence inside of blocks",
                    lrp_swapped_distortion_jump, "root-mean-square over 2^-10 pixel, σ"),
      structure_row("lrp_jump", "Jump at borders of windows, cells and blocks", lrp_jump,
                    "largest over 2^-12 pixel, standard deviations", Better::lower),
      structure_row("lrp_fixed_time_ratio", "Time with fixed phases over time without", lrp_fixed_time_ratio,
                    "processor time of points, as many cosines"),
      structure_row("lrp_placement_time_ratio", "Time with random placement over time without",
                    lrp_placement_time_ratio, "processor time of points"),
      structure_row("lrp_radial_change", "Change of the structure's radial power", lrp_radial_change,
                    "mean |dB| of octaves, by turbulence and placement", Better::lower),
      estimate_row("lrp_welch_ratio", "Error of Welch's estimate over that of a periodogram", lrp_welch_ratio,
                   "of the model's own noise", Better::lower),
      estimate_row("lrp_series_error", "Noise of wide windows against a Fourier series", lrp_series_error,
                   "root-mean-square difference a period away over the deviation", Better::lower),
      estimate_row("lrp_noise_filter_error", "Clamped noise against means over pixels", lrp_noise_filter_error,
                   "pixels of 8 x 8", Better::lower),
      estimate_row("lrp_noise_aliasing_error", "Noise at points against means over pixels", lrp_noise_aliasing_error,
                   "pixels of 8 x 8"),
      estimate_row("lrp_structure_filter_error", "Clamped structure with mip map against means over pixels",
                   lrp_structure_filter_error, "pixels of 8 x 8", Better::lower),
      estimate_row("lrp_structure_clamp_error", "Clamped structure against means over pixels",
                   lrp_structure_clamp_error, "pixels of 8 x 8, no mip map"),
      estimate_row("lrp_structure_aliasing_error", "Structure at points against means over pixels",
                   lrp_structure_aliasing_error, "pixels of 8 x 8"),
      estimate_row("lrp_structure_survival", "Survival", lrp_structure_survival,
                   "part of the non-Gaussianity, skewness and kurtosis in five octaves, that fixed phases keep",
                   Better::higher),
      estimate_row("lrp_suggested_structure", "Suggested part of fixed phases", lrp_suggested_structure,
                   "least r that keeps half of the non-Gaussianity")};
  return entries;
}

}  // namespace textonbench
