// Distribution of small patches, against the Gaussian law of the target's patches.
#pragma once

#include <memory>

#include "experiments/metrics/metric.h"

namespace textonbench {

/// Sliced squared Wasserstein-2 distance between the patches of a sample and the Gaussian law that the target's patches
/// have (as in Rabin et al., SSVM 2011, with a law in closed form on one side, so that no noise of a reference enters).
///
/// Patches are w x w pixels of all channels, w = 3 and 8, on the sample and on its halves and quarters (averages of 2 x
/// 2 pixels). They stand on a square grid of spacing max(1, ⌊w / 2⌋), or more where they would be over 10⁴, and do not
/// cross the border. Each of 512 unit directions θ, shared evenly among the (w, scale) pairs and drawn once from
/// `seed`, gives a projection that is N(θ·m, θᵀΣθ) under the target, Σ being the exact covariance of a patch at that
/// scale. With z_1 <= … <= z_n the standardized projections of the n patches, the distance between their empirical law
/// and N(0, 1),
///
///   W2² = 1 + (1/n) Σ z_i² − (2/n) Σ a_i z_i,   a_i = n ∫_{(i−1)/n}^{i/n} Φ⁻¹(u) du,
///
/// is averaged over directions and samples. A ratio to the projection's target variance: (1 − a)² for a contrast of a
/// times the target's, 1 + ((c − m)/s)² for a constant. The exact law scores the discretization and sampling noise,
/// about log(log n) / n for n independent patches and more for correlated ones. Pairs that find no patch, and
/// directions in which the target has less than 1e-6 of its variance, are left out. Throws std::invalid_argument for
/// samples smaller than 3 x 3.
std::unique_ptr<SampleMetric> patch_distance(const Target& target, const Domain& domain, Seed seed);

/// The same to the Gaussian law with the mean and covariance of the model itself, so that it tells the number of
/// impacts apart from the error of the texton. Null for a model that sums no texton.
std::unique_ptr<SampleMetric> limit_patch_distance(const Model& model, const Domain& domain, Seed seed);

}  // namespace textonbench
