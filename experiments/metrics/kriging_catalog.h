// The rows of the catalog that measure kriging and conditional simulation.
#pragma once

#include <span>

#include "experiments/metrics/metric.h"

namespace textonbench {

/// Those that cost more than a solution of the system are identities: measured when asked for.
std::span<const MetricEntry> kriging_metrics();

}  // namespace textonbench
