// Statements on the law of texton noise (Galerne, Leclaire, Moisan, CGF 2017, Sections 4, 7 and 10), held against
// quadrature (spline_law.h) and against samples. Points are drawn from the exemplar's name.
//
// "Deviation" is largest_deviation (replicates.h) of 256 independent samples of 64 x 64 pixels of the noise of the
// model's texton, of 30 impacts: at most 1 but in 1 % of the cases when the statement holds. Nothing for models that
// sum no splines or those of more than one texton, or whose texton is zero in a channel.
#pragma once

#include <optional>

#include "experiments/metrics/metric.h"

namespace textonbench {

/// Largest difference between the autocorrelation of the bilinear kernel (1 − |x|)₊ (1 − |y|)₊ at the lags |j| <= 2, by
/// quadrature, and the outer product of (0, 1/6, 2/3, 1/6, 0). Whatever the model.
std::optional<double> bilinear_autocorrelation_error(const Model& model, const Target& target, const Domain& domain);

/// Least value of the transform of that autocorrelation on a grid of 64 x 64 frequencies. Whatever the model.
std::optional<double> bilinear_power_least(const Model& model, const Target& target, const Domain& domain);

/// Deviation of the covariance at the whole lags |v|∞ <= 36 from α * α~ * b, on the grids Z², Z² + (1/4, 1/4) and
/// Z² + (1/2, 1/2) at once (Section 4.1, eq. 4).
std::optional<double> shifted_covariance_deviation(const Model& model, const Target& target, const Domain& domain);

/// Deviation of the covariance at lags of multiples of a quarter pixel, |v|∞ <= 3 pixels, from the spline of order
/// 2k + 1 with the coefficients α * α~; on samples of 16 x 16 pixels (Section 10).
std::optional<double> subpixel_covariance_deviation(const Model& model, const Target& target, const Domain& domain);

/// Deviation from the mean of the texture of noise whose impacts have random signs and whose expectation is not taken
/// off, and that of its covariance at whole lags |v|∞ <= 36 from the one without signs (Section 7).
std::optional<double> signed_mean_deviation(const Model& model, const Target& target, const Domain& domain);
std::optional<double> signed_covariance_deviation(const Model& model, const Target& target, const Domain& domain);

/// Variance of the noise over that of the exemplar's periodic component, the largest over channels (Section 4.3).
std::optional<double> kept_channel_variance(const Model& model, const Target& target, const Domain& domain);

/// Largest difference between the coefficients of order 0 on 31 x 31 pixels and the synthesis-oriented texton from the
/// same start, over the largest of them (Section 10). Nothing for exemplars with a shorter side; whatever the model.
std::optional<double> order_zero_difference(const Model& model, const Target& target, const Domain& domain);

}  // namespace textonbench
