// What local random-phase noise is estimated from and filtered by, held against references: all null for a model of
// another kind.
#pragma once

#include <optional>

#include "experiments/metrics/metric.h"

namespace textonbench {

/// Error of Welch's estimate over that of a single periodogram of the same side: sqrt(Σ (P̂ − P)² / Σ P²), of samples of
/// the exemplar's size of the model's own noise, whose spectrum P is known; of the first channel.
std::optional<double> lrp_welch_ratio(const Model& model, const Target& target, const Domain& domain);
/// Root-mean-square difference between the noise and itself a period of its bins away, over its deviation, its windows
/// being ten thousand times as wide: zero of a Fourier series.
std::optional<double> lrp_series_error(const Model& model, const Target& target, const Domain& domain);
/// Root-mean-square distance of values from means over pixels of 8 x 8, over the standard deviation of the values: of
/// the noise with its frequencies clamped, and as it is.
std::optional<double> lrp_noise_filter_error(const Model& model, const Target& target, const Domain& domain);
std::optional<double> lrp_noise_aliasing_error(const Model& model, const Target& target, const Domain& domain);
/// The same of the structure, with a mip map of its blocks' means, with its frequencies clamped alone, and as it is.
/// Null without a structure.
std::optional<double> lrp_structure_filter_error(const Model& model, const Target& target, const Domain& domain);
std::optional<double> lrp_structure_clamp_error(const Model& model, const Target& target, const Domain& domain);
std::optional<double> lrp_structure_aliasing_error(const Model& model, const Target& target, const Domain& domain);
/// Part of the exemplar's non-Gaussianity that survives when all phases but those of r are randomized, and the least r
/// with half of it (lrp_suggestion.h).
std::optional<double> lrp_structure_survival(const Model& model, const Target& target, const Domain& domain);
std::optional<double> lrp_suggested_structure(const Model& model, const Target& target, const Domain& domain);

}  // namespace textonbench
