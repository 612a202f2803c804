// What a small window of a large texture costs.
#pragma once

#include <optional>

#include "experiments/metrics/metric.h"

namespace textonbench {

/// Time of a 64 x 64 window in the middle of a plane domain of 16384 x 16384 pixels over that of the same window at its
/// corner, each the median of 101 syntheses that take turns: 1 for a noise that is evaluated on demand (EUSIPCO 2014,
/// 2.4). A measured time. Nothing for models that sum no texton.
std::optional<double> distant_window_ratio(const Model& model, const Target& target, const Domain& domain);

}  // namespace textonbench
