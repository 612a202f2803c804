// Moments of the marginal law: each channel of a sample standardized by the target, z = (u − mean) / sd.
//
// The statistic of a sample is its power means (1/|Ω|) Σ zʲ. Metrics are functions of their average over samples, so
// "the sample set" below is all samples together. A channel of the exemplar that does not vary has no sd: its mean is
// held against the largest sd of the other channels, and the shape of its marginal is not looked at.
#pragma once

#include <memory>

#include "experiments/metrics/metric.h"

namespace textonbench {

/// sqrt(mean over channels of ((m̂ − mean) / sd)²), m̂ the mean of the sample set. In target standard deviations; 0 on a
/// torus of the exact law, where the mean of every sample is exact, else about 1 / sqrt(effective pixels).
std::unique_ptr<SampleMetric> mean_error(const Target& target, const Domain& domain, Seed seed);

/// Mean over channels of μ₃ / μ₂^{3/2}, central moments about the mean of the sample set. A ratio; 0 for a Gaussian.
/// value() throws std::invalid_argument when a channel of the samples does not vary although the target's does.
std::unique_ptr<SampleMetric> skewness(const Target& target, const Domain& domain, Seed seed);

/// Mean over channels of μ₄ / μ₂² − 3. A ratio; 0 for a Gaussian, at least −2. Throws as skewness does.
std::unique_ptr<SampleMetric> excess_kurtosis(const Target& target, const Domain& domain, Seed seed);

}  // namespace textonbench
