// The rows of the catalog that test statements on noise of splines, on surfaces and mixtures.
#pragma once

#include <span>

#include "experiments/metrics/metric.h"

namespace textonbench {

std::span<const MetricEntry> spline_identity_metrics();

}  // namespace textonbench
