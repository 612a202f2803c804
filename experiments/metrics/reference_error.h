// What an approximation of a slower model costs in quality.
#pragma once

#include <optional>

#include "experiments/metrics/metric.h"

namespace textonbench {

/// Root-mean-square distance of a sample to that of Model::reference() of the same seed on `domain`, over the standard
/// deviation of the model's own unfiltered noise, sqrt(∫h²) of its splines, all channels together. Pixels where the two
/// are equal bit for bit, such as a background, do not count. Nothing for a model without reference or splines.
std::optional<double> reference_error(const Model& model, const Target& target, const Domain& domain);

}  // namespace textonbench
