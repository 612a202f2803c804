// Metrics of frames that a renderer draws; experiments/gpu_run.h measures them.
#pragma once

#include <span>

#include "experiments/metrics/metric.h"

namespace textonbench {

/// All of level MetricLevel::frame. Those whose names begin with "software_" are of frames drawn in software.
std::span<const MetricEntry> frame_metrics();

}  // namespace textonbench
