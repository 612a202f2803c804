// What an approximation of a slower model costs in quality.
#pragma once

#include <optional>

#include "experiments/metrics/metric.h"

namespace textonbench {

/// Root-mean-square distance of two images of a noise, over the standard deviation of that noise unfiltered,
/// sqrt(∫h²) of its splines, all channels together. Pixels where the two are equal bit for bit, such as a background,
/// do not count.
double distance_in_deviations(const Image& found, const Image& expected, const SplineTexton& texton);

/// That distance of a sample to that of Model::reference() of the same seed on `domain`. Nothing for a
/// model without reference or splines.
std::optional<double> reference_error(const Model& model, const Target& target, const Domain& domain);

}  // namespace textonbench
