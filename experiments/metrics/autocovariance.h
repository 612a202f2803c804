// Covariance at all lags up to a reach L, against the target's.
//
//   error = sqrt(Σ_v ‖Ĉ(v) − Γ(v)‖_F² / Σ_v ‖Γ(v)‖_F²),   |v_x| <= L_x, |v_y| <= L_y,
//
// a ratio: 0 for the exact law up to sampling noise, 1 for samples that do not vary. Γ is the target's law on the
// domain (target_law.h). Ĉ is estimated with the target's mean m, so it has no bias:
//
//   Ĉ_{cd}(v) = (1/N_v) Σ_x (u_c(x + v) − m_c) (u_d(x) − m_d),
//
// the sum running over the torus on a periodic domain (N_v = W H), else over the N_v = (W − |v_x|)(H − |v_y|) pairs of
// pixels inside the sample. The statistic of a sample is Ĉ on half of the lags, as Ĉ(−v) = Ĉ(v)ᵀ: C² (2 L_x L_y + L_x +
// L_y + 1) floats at most. L never exceeds (side − 1) / 2.
#pragma once

#include <memory>

#include "experiments/metrics/metric.h"

namespace textonbench {

/// L = 8 pixels: the scale of the grain.
std::unique_ptr<SampleMetric> autocovariance_error_8(const Target& target, const Domain& domain, Seed seed);
/// L = 32 pixels.
std::unique_ptr<SampleMetric> autocovariance_error_32(const Target& target, const Domain& domain, Seed seed);
/// L = (W / 4, H / 4) of the samples: shows a support that was cut.
std::unique_ptr<SampleMetric> autocovariance_error_quarter(const Target& target, const Domain& domain, Seed seed);

/// L = 32 pixels, against another law: the periodic autocorrelation of the exemplar as it is, border jumps included.
std::unique_ptr<SampleMetric> circular_autocovariance_error(const Target& target, const Domain& domain, Seed seed);

}  // namespace textonbench
