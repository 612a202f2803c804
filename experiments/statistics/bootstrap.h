// Mean of a two-level sample (exemplars, and seeds within each) with a bootstrap interval.
#pragma once

#include <vector>

#include "methods/base/random.h"

namespace textonbench {

/// Numbers by [exemplar][seed]. Exemplars may have different numbers of seeds; each has at least one.
using Levels = std::vector<std::vector<double>>;

/// A number with a confidence interval. Bounds are infinite where the data cannot give one.
struct Estimate {
  double value = 0, low = 0, high = 0;
};

/// The mean over exemplars of the means over seeds, and the p-value of "that mean is zero".
struct TestedMean {
  Estimate estimate;
  double p_value = 1;
};

/// Two-level bootstrap-t. A replicate draws exemplars with replacement, then seeds within each, and is studentized:
/// t* = (D* − D) / s*, with s the standard error sqrt(Σ (d_e − D)² / (n (n − 1))) of the n exemplar means d_e. The
/// interval is [D − s q(1 − α/2), D − s q(α/2)] with the quantiles q of t*.
///
/// Not percentile or BCa, which cover too little for few exemplars, and too much where seeds vary more than exemplars,
/// since the second level then counts the seeds' variance twice; s* takes it out again. Coverage of the 95 % interval
/// over 1000 synthetic sets (bootstrap_test prints it; standard error 0.7 %):
///
///   exemplars x seeds   deviations: between, within   Gaussian   exponential
///   13 x 4              1, 0.5                        94.9 %     93.9 %
///   13 x 4              0.2, 2                        94.9 %     94.9 %
///   13 x 1              1, 1                          94.3 %
///    6 x 4              1, 0.5                        95.4 %
///    3 x 4              1, 0.5                        95.2 %
///    1 x 8              0, 1                          94.8 %
///   20 x 10             1, 1                                     93.1 %
///
/// Laws more skewed than the exponential are covered less.
///
/// One exemplar: its seeds take the exemplars' place, so the interval is for that exemplar alone. Fewer than four
/// exemplars (or seeds of the only one), or so many ties that replicates have no spread: Student's t instead. A single
/// number has the interval (−∞, ∞). Equal exemplar means have an interval of no width.
///
/// The result depends on the arguments alone. Throws std::invalid_argument when there is no exemplar, one has no
/// number, a number is not finite, the confidence is outside (0, 1) or there are fewer than 100 replicates.
TestedMean test_mean(const Levels& levels, double confidence, int replicates, Seed seed);

/// Its estimate alone.
Estimate bootstrap_mean(const Levels& levels, double confidence, int replicates, Seed seed);

}  // namespace textonbench
