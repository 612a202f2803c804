// A window of a circular spot noise against one of the noise of the whole plane (EUSIPCO 2014, 2.2). With a kernel of
// S.w x S.h pixels, the law on 64 x 64 pixels is the same once the torus has 64 + S.w − 1 by 64 + S.h − 1: no lag of
// the window, wrapped round it, comes within S − S of zero. The "small" torus lacks 14 pixels on each side, and must
// fail.
//
// Nothing for models that sum no texton or more than one.
#pragma once

#include <optional>

#include "experiments/metrics/metric.h"

namespace textonbench {

/// max over lags |v|∞ < 64 and channels of |Γ_torus(v) − Σ_x h(x + v) h(x)| / Σ_x h(x)², from the closed form of the
/// noise on the torus. It decides the Gaussian limit.
std::optional<double> torus_crop_error(const Model& model, const Target& target, const Domain& domain);
std::optional<double> small_torus_crop_error(const Model& model, const Target& target, const Domain& domain);

/// largest_deviation (replicates.h), over 512 samples of Poisson noise on the torus at 30 impacts, each cropped to 64 x
/// 64 pixels, of their covariance at the lags |v|∞ < 64 from that on the plane. Points are drawn from the exemplar's
/// name.
std::optional<double> torus_crop_deviation(const Model& model, const Target& target, const Domain& domain);
std::optional<double> small_torus_crop_deviation(const Model& model, const Target& target, const Domain& domain);

}  // namespace textonbench
