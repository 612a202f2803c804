#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "experiments/metrics/metric.h"

namespace textonbench::catalog_test {

TEST(MetricCatalog, NamesAndOrderAreThoseThatScriptsKnow) {
  std::vector<std::string_view> names;
  names.reserve(metric_catalog().size());
  for (const MetricEntry& entry : metric_catalog()) names.push_back(entry.name);
  EXPECT_THAT(
      names,
      testing::ElementsAre(
          "rme", "smoothed_rme", "rme_printed", "ot_distance", "rme_corrected", "rme_bound", "kept_variance",
          "kernel_kurtosis", "predicted_kurtosis", "local_kurtosis_least", "local_kurtosis_greatest", "poisson_impacts",
          "stratified_impacts", "mean_error", "color_covariance_error", "autocovariance_error_8",
          "autocovariance_error_32", "autocovariance_error_quarter", "log_spectral_distance", "skewness",
          "excess_kurtosis", "cramer_von_mises", "patch_distance", "limit_patch_distance", "verbatim_copy",
          "autocorrelation_peak_error", "analyze_seconds", "synthesize_seconds", "ns_per_pixel", "model_bytes",
          "operations_per_pixel", "modulus_error", "rayleigh_distance", "phase_uniformity",
          "circular_autocovariance_error", "periodic_laplacian_error", "axis_energy_ratio", "axis_power_error",
          "transport_identity_error", "window_transport_ratio", "projection_distance_ratio", "spot_symmetry_error",
          "impact_mean_deviation", "impact_covariance_deviation", "impacts_on_pixel_ratio", "campbell_deviation",
          "dependence_reach", "distant_dependence", "torus_crop_error", "small_torus_crop_error",
          "torus_crop_deviation", "small_torus_crop_deviation", "kurtosis_slope", "canonical_central_energy",
          "canonical_side_peak", "canonical_law_error", "distant_window_ratio", "reference_error",
          "bilinear_autocorrelation_error", "bilinear_power_least", "shifted_covariance_deviation",
          "subpixel_covariance_deviation", "signed_mean_deviation", "signed_covariance_deviation",
          "kept_channel_variance", "order_zero_difference", "knot_exponent", "subpixel_anisotropy", "subpixel_gradient",
          "covariance_overshoot", "surface_mean_deviation", "surface_variance_deviation", "surface_impacts_ratio",
          "surface_variance_ratio", "barycenter_distance_error", "barycenter_end_error", "neighbor_texton_correlation",
          "unlike_start_correlation", "strip_border_ratio", "cells_visited", "impacts_drawn_ratio", "fetches_per_pixel",
          "gaussian_count_mean", "gaussian_count_variance", "negative_count_part", "congruential_cell_correlation",
          "hashed_cell_correlation", "counter_cell_correlation", "cell_time_ratio", "texton_time_ratio",
          "exemplar_patch_distance", "frame_ms", "frame_ns_per_pixel", "frame_fetches_per_second",
          "frame_ceiling_fraction", "frame_color_ratio", "software_frame_ms", "software_ns_per_pixel",
          "software_color_ratio", "sampler_filter_error", "supersampling_error", "kriging_residual",
          "kriging_iterations", "kriging_unknowns", "kriging_setup_seconds", "kriging_solve_seconds",
          "kriging_iteration_seconds", "kriging_bytes", "kriging_error", "kriging_condition_number",
          "kriging_border_distance", "kriging_variance_ratio", "conditional_mean_deviation",
          "conditional_covariance_deviation", "kriging_innovation_correlation", "hole_covariance_ratio",
          "estimate_bias", "lrp_least_windows", "lrp_most_windows", "lrp_envelope_ripple", "lrp_variance_ripple",
          "lrp_leakage_exponent", "lrp_window_error", "lrp_five_terms_error", "lrp_concentration_ratio",
          "lrp_radial_energy", "lrp_stratum_variance_error", "lrp_strata_imbalance", "lrp_erosion_energy",
          "lrp_coverage", "lrp_calls", "lrp_calls_ratio", "lrp_copy_error", "lrp_printed_copy_error",
          "lrp_structure_deviation", "lrp_block_side", "lrp_table_entries", "lrp_distortion_jump",
          "lrp_swapped_distortion_jump", "lrp_jump", "lrp_fixed_time_ratio", "lrp_placement_time_ratio",
          "lrp_radial_change", "lrp_welch_ratio", "lrp_series_error", "lrp_noise_filter_error",
          "lrp_noise_aliasing_error", "lrp_structure_filter_error", "lrp_structure_clamp_error",
          "lrp_structure_aliasing_error", "lrp_structure_survival", "lrp_suggested_structure", "gabor_kernels",
          "gabor_windows", "gabor_impacts"));
}

TEST(MetricCatalog, EveryEntryIsDescribedAndCanBeMeasuredAtItsLevel) {
  for (const MetricEntry& entry : metric_catalog()) {
    SCOPED_TRACE(entry.name);
    EXPECT_FALSE(entry.title.empty());
    EXPECT_FALSE(entry.unit.empty());
    EXPECT_FALSE(entry.reference.empty());
    EXPECT_EQ(entry.of_model != nullptr, entry.level == MetricLevel::model);
    EXPECT_EQ(entry.of_samples != nullptr || entry.of_limit != nullptr, entry.level == MetricLevel::sample);
    EXPECT_FALSE(entry.of_samples != nullptr && entry.of_limit != nullptr);
    EXPECT_EQ(&find_metric(entry.name), &entry);
  }
}

TEST(MetricCatalog, AnUnknownNameIsToldWithTheNearestOne) {
  try {
    find_metric("skewnes");
    FAIL() << "expected an error";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "unknown metric \"skewnes\" (did you mean \"skewness\"?); \"textonbench list metrics\" "
                 "shows all");
  }
}

}  // namespace textonbench::catalog_test
