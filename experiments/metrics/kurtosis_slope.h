// How fast a spot noise tends to its Gaussian limit.
#pragma once

#include <optional>
#include <span>

#include "experiments/metrics/metric.h"

namespace textonbench {

/// Exponent b of the power law a MNI^b that is fitted to the excess kurtosis of samples with 5, 15, 50, 150 and 500
/// Poisson impacts on a pixel: −1 in theory, as the kurtosis is κ / MNI (EUSIPCO 2014, 2.1; methods/spot/
/// kernel_moments.h). Of each number of impacts 16 samples of 512 x 512 pixels are drawn, of which the kurtosis is the
/// mean over channels that vary and its standard error the jackknife's. Points are drawn from the exemplar's name.
/// Nothing for models that sum no texton.
std::optional<double> kurtosis_slope(const Model& model, const Target& target, const Domain& domain);

/// b of the weighted least squares Σ_i (y_i − a x_i^b)² / error_i² over a > 0 and b, by Gauss–Newton from the line
/// through the logarithms of the first two points. Throws std::invalid_argument unless there are at least two points,
/// x > 0, the first two y > 0 and all errors > 0.
double fitted_exponent(std::span<const double> x, std::span<const double> y, std::span<const double> errors);

}  // namespace textonbench
