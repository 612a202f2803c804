// The covariance of a stationary field between the pixels of a box, applied by Fourier transforms in double precision.
#pragma once

#include <complex>
#include <memory>
#include <vector>

#include "methods/conditional/gaussian_field.h"

namespace textonbench {

/// Γ_cd(v) = Cov(Y_c(x + v), Y_d(x)) for all lags v between pixels of a box of size `box`, without the nugget.
///
/// On the plane Γ is the aperiodic autocorrelation of the spot. Only lags smaller than the box matter, so it is cut off
/// there and wrapped around a torus of the smallest good size >= 2 box − 1: a hole of 100 x 100 in a large picture
/// needs transforms of 216 x 216. On a torus whose side is smaller than that, the grid is that torus.
class BoxCovariance {
 public:
  /// Buffers of one application, for one thread's use.
  class Workspace;

  /// Throws std::invalid_argument when the box is larger than the torus of a periodic field.
  BoxCovariance(const GaussianField& field, Extent torus, Extent box);

  Extent box() const { return box_; }
  Extent grid() const { return grid_; }
  int channels() const { return channels_; }
  std::size_t bytes() const;

  /// Replaces the planes, of size box(), by (Γ f)_c(x) = Σ_d Σ_y Γ_cd(x − y) f_d(y), y in the box: one forward and one
  /// inverse transform a channel and the product of a Hermitian matrix a frequency. Rows that are zero outside the box
  /// are never transformed. The bits do not depend on the number of threads.
  void apply(Planes& fields) const;

  /// Γ_cd(v) for |v_x| < reach.width, |v_y| < reach.height (at most the box).
  class Lags;
  Lags lags(Extent reach) const;

 private:
  Extent box_, grid_;
  int channels_ = 0;
  std::vector<std::vector<double>> diagonal_;                    ///< Γ̂_cc, real
  std::vector<std::vector<std::complex<double>>> off_diagonal_;  ///< Γ̂_cd, c < d, in lexical order
};

/// A table of covariances by lag.
class BoxCovariance::Lags {
 public:
  Lags(Extent reach, int channels);
  Extent reach() const { return reach_; }
  double at(int c, int d, int vx, int vy) const { return planes_[index(c, d, vx, vy)]; }
  void set(int c, int d, int vx, int vy, double value) { planes_[index(c, d, vx, vy)] = value; }

 private:
  std::size_t index(int c, int d, int vx, int vy) const {
    const std::int64_t width = 2 * std::int64_t{reach_.width} - 1;
    const std::int64_t height = 2 * std::int64_t{reach_.height} - 1;
    return static_cast<std::size_t>(((c * channels_ + d) * height + vy + reach_.height - 1) * width + vx +
                                    reach_.width - 1);
  }

  Extent reach_;
  int channels_ = 0;
  std::vector<double> planes_;
};

}  // namespace textonbench
