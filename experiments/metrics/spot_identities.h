// Statements of theory about discrete spot noise, held against samples that are drawn from the definition
// (spot_samples.h) with the kernel of the model. F is the raw noise Σ_i h(x − x_i) of a Poisson process of λ = MNI /
// |S| impacts a pixel, h the model's kernel, channel by channel. Points are drawn from the exemplar's name.
//
// "Deviation" is largest_deviation (replicates.h) of 256 independent samples: at most 1 but in 1 % of the cases when
// the statement holds. Nothing for models that sum no texton or more than one, whose kernel is zero in a channel or has
// a support of 25 pixels or less.
#pragma once

#include <optional>

#include "experiments/metrics/metric.h"

namespace textonbench {

/// Deviation of the mean of windows of 64 x 64 pixels from λ Σ_x h(x), at 5, 30 and 100 impacts (EUSIPCO 2014, 2.1).
std::optional<double> impact_mean_deviation(const Model& model, const Target& target, const Domain& domain);

/// Deviation of the covariance at the lags |v|∞ <= 40 of windows of 96 x 96 pixels from λ Σ_x h(x + v) h(x), which is
/// zero off S − S, at 5, 30 and 100 impacts (EUSIPCO 2014, 2.1).
std::optional<double> impact_covariance_deviation(const Model& model, const Target& target, const Domain& domain);

/// Mean number of impacts whose support covers a pixel, in windows of 64 x 64 pixels at 30 impacts, over 30 (EUSIPCO
/// 2014, 2.4).
std::optional<double> impacts_on_pixel_ratio(const Model& model, const Target& target, const Domain& domain);

/// Deviation, over 4096 values of F at one pixel with 5 and 30 impacts each, of its mean from λ Σ h, its variance from
/// λ Σ h² and its characteristic function E exp(itF) from exp(λ Σ_x (exp(it h(x)) − 1)) at t = 1/2, 1 and 2 over the
/// standard deviation of F: Campbell's theorem.
std::optional<double> campbell_deviation(const Model& model, const Target& target, const Domain& domain);

/// Largest distance between two pixels of the support over the longer side of its box minus one pixel: 1 for a disc,
/// whose box has the side 2r + 1. Pixels farther apart than that distance share no impact.
std::optional<double> dependence_reach(const Model& model, const Target& target, const Domain& domain);

/// Deviation from zero, at 30 impacts, of the covariance of F, and of (F − E F)², between pixels that are farther apart
/// than the side of the support's box minus one pixel, by at most 8 pixels along each axis (EUSIPCO 2014, 4).
std::optional<double> distant_dependence(const Model& model, const Target& target, const Domain& domain);

}  // namespace textonbench
