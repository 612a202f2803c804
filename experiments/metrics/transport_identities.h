// Statements of theory about laws of circular textures, held against computations that do not use them, on small crops
// of the exemplar: one from its upper left corner and one from its middle. Nothing for an exemplar that is too small
// for two crops, or flat there.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "experiments/metrics/metric.h"

namespace textonbench {

/// |D − d| / D for the squared Wasserstein-2 distance a pixel d in closed form (EUSIPCO 2014, eq. 1) and the same
/// distance D of the dense Gaussian laws, by square roots of their matrices; on 8 x 8 tori.
std::optional<double> transport_identity_error(const Model& model, const Target& target, const Domain& domain);

/// Squared distance a pixel of the laws restricted to a window of 8 x 8 pixels, over that on their 24 x 24 torus: at
/// most 1, since the best coupling on the torus is stationary.
std::optional<double> window_transport_ratio(const Model& model, const Target& target, const Domain& domain);

/// least_distance_ratio of phase_projection, on 24 x 24 crops: 1 when eq. 2 of EUSIPCO 2014 holds.
std::optional<double> projection_distance_ratio(const Model& model, const Target& target, const Domain& domain);

/// Largest difference between the periodic autocorrelations of h and of −h, h(−x) and −h(−x), channel by channel, over
/// that of h at lag zero; on a 24 x 24 crop.
std::optional<double> spot_symmetry_error(const Model& model, const Target& target, const Domain& domain);

/// Covariance of the circular field W * h on a window of its torus, pixel by pixel and channel by channel, from the
/// definition: the field is a linear map of W. `spot` has any mean.
Eigen::MatrixXd window_covariance(const Image& spot, Extent window);

/// t̂ exp(iφ), φ = arg t̂* ĥ: the spot of t's law that is nearest to h.
Spectrum phase_projection(const Spectrum& h, const Spectrum& t);

/// Least of ‖candidate · exp(iδ) − h‖ over δ = 0 and 1000 random phase perturbations of sizes 0.01 to 10, divided by
/// the optimal-transport distance of the laws of h and t. For a minimizer 1; above 1 when the candidate is none, below
/// 1 when the closed form is none of a minimum.
double least_distance_ratio(const Spectrum& candidate, const Spectrum& h, const Spectrum& t, Seed seed);

}  // namespace textonbench
