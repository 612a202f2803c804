// What the time of texton noise depends on, point by point as a shader takes it (Galerne, Leclaire, Moisan, CGF 2017,
// Sections 8 and 9): processor time of 30 Poisson impacts at 256 points so far apart that each draws its own impacts,
// the median of 42 turns with what it is compared to. Nothing for models that sum no splines or those of more than one
// texton, or whose texton is zero in a channel.
#pragma once

#include <optional>

#include "experiments/metrics/metric.h"

namespace textonbench {

/// Time with cells of 0.6 sides of the support over the least with 0.2, 0.4, 0.6, 0.8, 1, 1.25 and 1.5.
std::optional<double> cell_time_ratio(const Model& model, const Target& target, const Domain& domain);

/// Time with the model's texton over that with one of the same size whose coefficients are all 1.
std::optional<double> texton_time_ratio(const Model& model, const Target& target, const Domain& domain);

}  // namespace textonbench
