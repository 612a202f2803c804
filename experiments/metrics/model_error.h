// Distance between the model's own Gaussian law and the target's, in closed form: no sampling noise, and zero for a
// model that reproduces the exemplar's spectrum. Both spectra are taken on the exemplar's torus whatever the domain,
// and the mean takes no part (EUSIPCO 2014, eq. 1; gaussian_model.h). Nothing when the model has no closed-form law.
#pragma once

#include <optional>

#include "experiments/metrics/metric.h"

namespace textonbench {

/// RME = sqrt(Σ_{ξ≠0} [tr P + tr Q − 2 tr (P^{1/2} Q P^{1/2})^{1/2}] / Σ_{ξ≠0} tr Q), P the model, Q the target. A
/// ratio; 1 for a model of no variation.
std::optional<double> rme(const Model& model, const Target& target, const Domain& domain);

/// RME of both spectra smoothed: each is the expected periodogram of blocks of T x T pixels under a Hann taper, T the
/// largest power of two below the exemplar's sides. Unlike a single periodogram, which the target's spectrum is, a
/// smooth spectrum can come near it.
std::optional<double> smoothed_rme(const Model& model, const Target& target, const Domain& domain);

/// The same as rme() without the factor 2, as EUSIPCO 2014 prints it: 1 for every P whose overlap with Q equals its own
/// energy, so 1 for a perfect model.
std::optional<double> rme_printed(const Model& model, const Target& target, const Domain& domain);

/// sqrt(W2² / |Ω|): root of the squared Wasserstein-2 distance a pixel, all channels together, in the exemplar's
/// values.
std::optional<double> ot_distance(const Model& model, const Target& target, const Domain& domain);

}  // namespace textonbench
