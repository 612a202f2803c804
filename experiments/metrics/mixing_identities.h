// Statements on mixtures of two textures (Galerne, Leclaire, Moisan, CGF 2017, Section 7), on two crops of the
// exemplar: one from its upper left corner and one from its middle, whatever the model. Nothing for an exemplar that is
// too small for two crops, or flat there.
#pragma once

#include <optional>

#include "experiments/metrics/metric.h"

namespace textonbench {

/// Largest of |d(0, ρ) − ρ d| and |d(ρ, 1) − (1 − ρ) d| over d, for ρ = 1/4, 1/2 and 3/4: d(ρ, σ) is the distance of
/// the dense laws of the barycenters on 8 x 8 tori, by square roots of their matrices, and d = d(0, 1).
std::optional<double> barycenter_distance_error(const Model& model, const Target& target, const Domain& domain);

/// Largest difference between the dense covariances of the barycenters of ρ = 0 and 1 and those of the two crops, over
/// the largest variance; on 8 x 8 tori.
std::optional<double> barycenter_end_error(const Model& model, const Target& target, const Domain& domain);

/// Mean correlation <t_r, t_(r+1)> / (‖t_r‖ ‖t_(r+1)‖) of consecutive ones of 21 textons of 15 x 15 bilinear splines,
/// fitted to the barycenters of ρ = r / 20 of crops of 64 x 64 pixels: all from one start, or each from its own.
std::optional<double> neighbor_texton_correlation(const Model& model, const Target& target, const Domain& domain);
std::optional<double> unlike_start_correlation(const Model& model, const Target& target, const Domain& domain);

/// Mean squared horizontal difference of neighboring pixels across the borders of strips over that inside strips, in 32
/// samples of 256 x 64 pixels of the mixture of crops of 64 x 64 pixels by 21 textons, 30 impacts.
std::optional<double> strip_border_ratio(const Model& model, const Target& target, const Domain& domain);

}  // namespace textonbench
