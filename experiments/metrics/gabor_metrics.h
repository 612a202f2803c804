// What Gabor noise takes to be stored and drawn. Nothing of other models.
#pragma once

#include <optional>
#include <span>

#include "experiments/metrics/metric.h"

namespace textonbench {

/// Kernels that impacts are drawn from: pairs of a window and a frequency.
std::optional<double> gabor_kernels(const Model& model, const Target& target, const Domain& domain);
/// Windows, each with a grid of impacts of its own.
std::optional<double> gabor_windows(const Model& model, const Target& target, const Domain& domain);
/// Mean number of kernels that reach a point.
std::optional<double> gabor_impacts(const Model& model, const Target& target, const Domain& domain);

/// The rows of the catalog.
std::span<const MetricEntry> gabor_metrics();

}  // namespace textonbench
