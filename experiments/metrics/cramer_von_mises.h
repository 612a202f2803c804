// Gaussianity of the marginals, tested on pixels that are practically independent.
#pragma once

#include <memory>

#include "experiments/metrics/metric.h"

namespace textonbench {

/// The smallest r >= 1 with |Γ_cc(v)| < 0.1 Γ_cc(0) at all lags v of the torus with max(|v_x|, |v_y|) = r, for the
/// channel c where it is largest (channels that do not vary left out); half of the longer side, plus 1, when there is
/// none. In pixels. Correlations beyond are not looked at: those of a single exemplar come back above 0.1 by chance, at
/// some far lag, in most coarse textures.
int decorrelation_length(const Target& target);

/// Mean over the channels that vary of the Cramér–von Mises statistic
///
///   T = 1 / (12 n) + Σ_i (Φ(z_i) − (2 i − 1) / (2 n))²,   z_1 <= … <= z_n,  z = (u − mean) / sd of the target,
///
/// of the n = max(1, ⌊W / s⌋) · max(1, ⌊H / s⌋) pixels of a square grid of spacing s = decorrelation_length, shifted by
/// a random offset that `seed` fixes; averaged over samples. A ratio. The exact law scores 1/6 for every n if the
/// pixels are independent; T is 1/12 + n/3 at most. From n = 20 on T has nearly its asymptotic law (95 % quantile
/// 0.461); with fewer pixels, down to one when the texture is correlated across half of the sample, it is still valid
/// but tells little of the marginal's shape.
std::unique_ptr<SampleMetric> cramer_von_mises(const Target& target, const Domain& domain, Seed seed);

}  // namespace textonbench
