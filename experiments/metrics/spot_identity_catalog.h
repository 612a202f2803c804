// The rows of the catalog that test statements on spot noise and textons.
#pragma once

#include <span>

#include "experiments/metrics/metric.h"

namespace textonbench {

std::span<const MetricEntry> spot_identity_metrics();

}  // namespace textonbench
