// How much of a sample is copied from the exemplar.
//
// The nearest patch of 7 x 7 pixels of the exemplar is found for pairs of neighboring pixels of the sample. A pair is
// copied when the two nearest patches are neighbors in the same way: for a picture of its own that happens by chance,
// in one of five pairs or so since their patches share six of seven columns, which the floor tells.
#pragma once

#include <memory>

#include "experiments/metrics/metric.h"

namespace textonbench {

/// Part of 128 pairs a sample.
std::unique_ptr<SampleMetric> verbatim_copy(const Target& target, const Domain& domain, Seed seed);

}  // namespace textonbench
