#include "experiments/metrics/spline_identity_catalog.h"

#include <array>

#include "experiments/metrics/exemplar_patches.h"
#include "experiments/metrics/mixing_identities.h"
#include "experiments/metrics/plane_impacts.h"
#include "experiments/metrics/point_cost.h"
#include "experiments/metrics/spline_identities.h"
#include "experiments/metrics/spline_smoothness.h"
#include "experiments/metrics/surface_identities.h"

namespace textonbench {
namespace {

using IdentityOfModel = std::optional<double> (*)(const Model&, const Target&, const Domain&);

constexpr MetricEntry spline_identity(std::string_view name, std::string_view title, std::string_view unit,
                                      Better better, std::string_view source, IdentityOfModel of_model,
                                      std::string_view reference) {
  return {.name = name,
          .title = title,
          .unit = unit,
          .level = MetricLevel::model,
          .better = better,
          .reference = reference,
          .source = source,
          .of_model = of_model,
          .identity = true};
}

}  // namespace

std::span<const MetricEntry> spline_identity_metrics() {
  static constexpr std::array entries{
      spline_identity("bilinear_autocorrelation_error", "Autocorrelation of the bilinear kernel", "1", Better::lower,
                      "spline_identities", bilinear_autocorrelation_error,
                      "max |quadrature − (1/6, 2/3, 1/6) ⊗ (1/6, 2/3, 1/6)| (Texton Noise 2017, 4.1); 0"),
      spline_identity("bilinear_power_least", "Least power of the bilinear kernel", "1", Better::neither,
                      "spline_identities", bilinear_power_least,
                      "min b̂ over 64 x 64 frequencies (Texton Noise 2017, 4.1); 1/9"),
      spline_identity("shifted_covariance_deviation", "Covariance of texton noise on shifted grids", "1",
                      Better::neither, "spline_identities", shifted_covariance_deviation,
                      "largest deviation / its limit at 1 %, shifts 0, 1/4, 1/2 (Texton Noise 2017, eq. 4); at most 1"),
      spline_identity("subpixel_covariance_deviation", "Covariance of texton noise between whole lags", "1",
                      Better::neither, "spline_identities", subpixel_covariance_deviation,
                      "largest deviation / its limit at 1 %, quarters of a pixel (Texton Noise 2017, 10); at most 1"),
      spline_identity("signed_mean_deviation", "Mean of texton noise of random signs", "1", Better::neither,
                      "spline_identities", signed_mean_deviation,
                      "largest deviation / its limit at 1 % (Texton Noise 2017, 7); at most 1"),
      spline_identity("signed_covariance_deviation", "Covariance of texton noise of random signs", "1", Better::neither,
                      "spline_identities", signed_covariance_deviation,
                      "largest deviation / its limit at 1 %, |v|∞ <= 36 (Texton Noise 2017, 7); at most 1"),
      spline_identity("kept_channel_variance", "Largest kept variance of a channel", "1", Better::neither,
                      "spline_identities", kept_channel_variance,
                      "variance of the noise / that of the periodic component, largest over channels"),
      spline_identity("order_zero_difference", "Order 0 against the synthesis-oriented texton", "1", Better::lower,
                      "spline_identities", order_zero_difference,
                      "max |difference| / max |coefficient|, 31 x 31 (Texton Noise 2017, 10); 0"),
      spline_identity(
          "knot_exponent", "Continuous derivatives at knots, plus one", "1", Better::neither, "spline_smoothness",
          knot_exponent,
          "s of m(step) ~ step^(2s + 1), m the mean square of differences of order k + 2 (Texton Noise 2017, 10)"),
      spline_identity(
          "subpixel_anisotropy", "Diagonal against axial changes at a twentieth of a pixel", "1", Better::neither,
          "spline_smoothness", subpixel_anisotropy,
          "E |f(y + εu) − f(y)|², u diagonal / u axial, ε = 1/20 (Texton Noise 2017, 10); 1 where isotropic"),
      spline_identity("subpixel_gradient", "Squared gradient at a twentieth of a pixel", "1/pixel²", Better::neither,
                      "spline_smoothness", subpixel_gradient,
                      "E |f(y + εu) − f(y)|² / (ε² Var f), ε = 1/20, both axes (Texton Noise 2017, 10)"),
      spline_identity("covariance_overshoot", "Overshoot of the covariance between pixels", "1", Better::neither,
                      "spline_smoothness", covariance_overshoot,
                      "Σ of what γ(v + 1/2) exceeds the range of γ(v), γ(v + 1) by / γ(0), v = 0 … 15 on both axes"),
      spline_identity("surface_mean_deviation", "Mean of surface noise against λ (r/2) ∫h", "1", Better::neither,
                      "surface_identities", surface_mean_deviation,
                      "largest deviation / its limit at 1 % (Texton Noise 2017, Proposition 3); at most 1"),
      spline_identity("surface_variance_deviation", "Variance of surface noise against λ (r/3) ∫h²", "1",
                      Better::neither, "surface_identities", surface_variance_deviation,
                      "largest deviation / its limit at 1 % (Texton Noise 2017, Proposition 3); at most 1"),
      spline_identity("surface_impacts_ratio", "Impacts that reach a surface point against λ r³", "1", Better::neither,
                      "surface_identities", surface_impacts_ratio,
                      "mean number counted at 60 impacts / 60 (Texton Noise 2017, Proposition 3); 1"),
      spline_identity("surface_variance_ratio", "Variance on a surface against the plane", "1", Better::neither,
                      "surface_identities", surface_variance_ratio,
                      "variance of samples / that of samples of the plane (Texton Noise 2017, 6); 1"),
      spline_identity("barycenter_distance_error", "Distance along the way of barycenters", "1", Better::lower,
                      "mixing_identities", barycenter_distance_error,
                      "max |d(0, ρ) − ρ d|, |d(ρ, 1) − (1 − ρ) d| over d, dense on 8 x 8 (Texton Noise 2017, 7); 0"),
      spline_identity("barycenter_end_error", "Ends of the way of barycenters", "1", Better::lower, "mixing_identities",
                      barycenter_end_error,
                      "max |covariance − that of the texture| / largest, dense on 8 x 8 (Texton Noise 2017, 7); 0"),
      spline_identity("neighbor_texton_correlation", "Correlation of consecutive textons of a mixture", "1",
                      Better::neither, "mixing_identities", neighbor_texton_correlation,
                      "mean over 20 pairs of 21 textons of one start (Texton Noise 2017, 7); 1 for equal ones"),
      spline_identity("unlike_start_correlation", "The same, each texton from its own start", "1", Better::neither,
                      "mixing_identities", unlike_start_correlation,
                      "mean over 20 pairs: the control that must be low"),
      spline_identity("strip_border_ratio", "Changes across the borders of strips against inside", "1", Better::neither,
                      "mixing_identities", strip_border_ratio,
                      "mean squared horizontal difference, at borders / elsewhere (Texton Noise 2017, 7); 1"),
      spline_identity("cells_visited", "Cells that a point visits", "cell", Better::neither, "plane_impacts",
                      cells_visited, "mean number counted (Texton Noise 2017, 8); (1 + r / a)²"),
      spline_identity("impacts_drawn_ratio", "Impacts drawn for a point over MNI", "1", Better::neither,
                      "plane_impacts", impacts_drawn_ratio,
                      "mean number counted / MNI (Texton Noise 2017, 8); (1 + a / r)²"),
      spline_identity("fetches_per_pixel", "Values of the texton that a point asks for", "fetch", Better::neither,
                      "plane_impacts", fetches_per_pixel, "mean number counted (Texton Noise 2017, 1); MNI"),
      spline_identity("gaussian_count_mean", "Mean of Gaussian numbers of impacts", "1", Better::neither,
                      "plane_impacts", gaussian_count_mean,
                      "of clamped numbers / 11.7 (Texton Noise 2017, 8); 1 for Poisson numbers"),
      spline_identity("gaussian_count_variance", "Variance of Gaussian numbers of impacts", "1", Better::neither,
                      "plane_impacts", gaussian_count_variance,
                      "of clamped numbers / 11.7 (Texton Noise 2017, 8); 1 for Poisson numbers"),
      spline_identity("negative_count_part", "Negative Gaussian numbers of impacts", "1", Better::neither,
                      "plane_impacts", negative_count_part,
                      "part of the cells of 11.7 impacts on average (Texton Noise 2017, 8); 0 for Poisson numbers"),
      spline_identity("congruential_cell_correlation", "Correlation of cells, congruential generator", "1",
                      Better::neither, "plane_impacts", congruential_cell_correlation,
                      "largest deviation / its limit at 1 % (Texton Noise 2017, 8); at most 1 for independent cells"),
      spline_identity("hashed_cell_correlation", "Correlation of cells, hash and xorshift", "1", Better::neither,
                      "plane_impacts", hashed_cell_correlation,
                      "largest deviation / its limit at 1 % (Texton Noise 2017, 8); at most 1 for independent cells"),
      spline_identity("counter_cell_correlation", "Correlation of cells, Philox", "1", Better::neither, "plane_impacts",
                      counter_cell_correlation,
                      "largest deviation / its limit at 1 %; at most 1 for independent cells"),
      spline_identity(
          "cell_time_ratio", "Time with cells of 0.6 sides of the support", "1", Better::neither, "point_cost",
          cell_time_ratio,
          "over the least of cells of 0.2 to 1.5 sides, point by point (Texton Noise 2017, 8); 1 where none is faster"),
      spline_identity("texton_time_ratio", "Time against that of a constant texton", "1", Better::neither, "point_cost",
                      texton_time_ratio,
                      "point by point, one size (Texton Noise 2017, 9); 1 where the spectrum does not matter"),
      spline_identity("exemplar_patch_distance", "Patch distance of the exemplar itself", "1", Better::neither,
                      "exemplar_patches", exemplar_patch_distance,
                      "to its own Gaussian law (Texton Noise 2017, 9); the floor of patch_distance if it is Gaussian"),
  };
  return entries;
}

}  // namespace textonbench
