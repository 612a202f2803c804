// The Gaussian law that samples are held against, on the domain on which they were drawn.
//
// Its mean is the target's. On the exemplar's own torus its covariance is Target::covariance. On any other domain it is
// that of the asymptotic discrete spot noise on Z² with the target's spot t, zero outside the exemplar's rectangle,
//
//   Γ(v) = Σ_x t(x + v) t(x)ᵀ,
//
// which is folded, Σ_k Γ(v + k ∘ size), when the domain is a torus of another size. Both agree at lag zero.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "experiments/metrics/metric.h"

namespace textonbench {

/// Spectrum of the target's spot laid on the torus `grid` (wrapped round where the torus is smaller): on a grid that
/// holds all lags of interest apart, |t̂|² is the spectrum of Γ.
Spectrum spot_spectrum(const Target& target, Extent grid);

/// Γ_{cd}(v) for |v_x| <= reach.width, |v_y| <= reach.height.
class LagWindow {
 public:
  /// Throws as require_unit_step does.
  LagWindow(const Target& target, const Domain& domain, Extent reach);
  /// Of the law of a model, whose covariance on the plane is zero from lag `extent` on. Throws as require_unit_step.
  LagWindow(const Gaussian& law, Extent extent, const Domain& domain, Extent reach);

  int channels() const { return channels_; }
  Extent reach() const { return reach_; }
  double at(int c, int d, int x, int y) const {
    const std::int64_t plane = std::int64_t{c} * channels_ + d;
    const std::int64_t row = plane * (2 * reach_.height + 1) + y + reach_.height;
    return values_[static_cast<std::size_t>(row * (2 * reach_.width + 1) + x + reach_.width)];
  }

 private:
  void read(const Autocovariance& covariance);

  int channels_;
  Extent reach_;
  std::vector<double> values_;
};

/// Standard deviation of each channel of the target; exactly zero for a channel that does not vary (variance below 1e-9
/// of the largest one, what float32 rounding leaves).
std::vector<double> channel_deviations(const Target& target);

/// sample − mean, in the upper left corner of a zero image of `size`, which is at least the sample's.
Image centered(const Image& sample, std::span<const double> mean, Extent size);

/// The target's torus is the domain itself.
bool on_own_torus(const Target& target, const Domain& domain);

/// Throws std::invalid_argument when the step of the domain is not one pixel of the exemplar: lags are counted in
/// pixels.
void require_unit_step(const Domain& domain);

}  // namespace textonbench
