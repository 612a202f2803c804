// The rows of the catalog that hold local random-phase noise against its paper.
#pragma once

#include <span>

#include "experiments/metrics/metric.h"

namespace textonbench {

std::span<const MetricEntry> lrp_metrics();

}  // namespace textonbench
