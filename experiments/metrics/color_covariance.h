// Covariance of the channels at one pixel.
#pragma once

#include <memory>

#include "experiments/metrics/metric.h"

namespace textonbench {

/// Bures distance between the C x C covariance A of the sample set (about its own mean) and the target's B = Γ(0),
///
///   sqrt(tr A + tr B − 2 tr (A^{1/2} B A^{1/2})^{1/2}) / sqrt(tr B).
///
/// A ratio: |a − 1| for a contrast of a times the target's, 1 for samples of one color; 0 for the exact law up to
/// sampling noise of about sqrt(C / (2 · effective pixels)). The statistic is the first and second moments of sample −
/// target mean.
std::unique_ptr<SampleMetric> color_covariance_error(const Target& target, const Domain& domain, Seed seed);

}  // namespace textonbench
