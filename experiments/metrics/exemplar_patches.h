// How far an exemplar is from being Gaussian, whatever the model.
#pragma once

#include <optional>

#include "experiments/metrics/metric.h"

namespace textonbench {

/// patch_distance of the exemplar itself: what a noise with its very mean and covariance still lacks. The floor of
/// patch_distance on the exemplar's torus is what it would be for a Gaussian exemplar. Nothing for exemplars smaller
/// than 3 x 3.
std::optional<double> exemplar_patch_distance(const Model& model, const Target& target, const Domain& domain);

}  // namespace textonbench
