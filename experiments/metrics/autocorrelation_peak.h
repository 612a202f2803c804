// How much of a near-regular texture's regularity samples keep.
//
// The lag is that of the largest autocorrelation of the exemplar's periodic component, its channels' traces summed, at
// a distance from 4 pixels to a third of the smaller side that is a local maximum. The number is the difference of the
// samples' autocorrelation there.
#pragma once

#include <memory>

#include "experiments/metrics/metric.h"

namespace textonbench {

/// |ρ of the samples − ρ of the exemplar| at that lag; 0 where the exemplar has no such maximum.
std::unique_ptr<SampleMetric> autocorrelation_peak_error(const Target& target, const Domain& domain, Seed seed);

}  // namespace textonbench
