// The covariance of a stationary field between the pixels of a box, applied by Fourier transforms in double precision.
#pragma once

#include <algorithm>
#include <complex>
#include <vector>

#include "methods/base/double_fft.h"
#include "methods/conditional/gaussian_field.h"

namespace textonbench {

/// Γ_cd(v) for |v_x| < reach.width and |v_y| < reach.height.
class CovarianceTable {
 public:
  CovarianceTable(Extent reach, int channels);
  Extent reach() const { return reach_; }
  double at(int c, int d, int vx, int vy) const { return planes_[index(c, d, vx, vy)]; }
  double& at(int c, int d, int vx, int vy) { return planes_[index(c, d, vx, vy)]; }

 private:
  std::size_t index(int c, int d, int vx, int vy) const {
    const std::int64_t width = 2 * std::int64_t{reach_.width} - 1;
    const std::int64_t height = 2 * std::int64_t{reach_.height} - 1;
    return static_cast<std::size_t>(((std::int64_t{c} * channels_ + d) * height + vy + reach_.height - 1) * width + vx +
                                    reach_.width - 1);
  }

  Extent reach_;
  int channels_ = 0;
  std::vector<double> planes_;
};

/// Half spectrum of one channel, column by column: bin (kx, ky) at kx * height + ky.
using Bins = std::vector<std::complex<double>>;

/// Transform of every channel of the spot wrapped around a torus of size `raster`.
std::vector<Bins> spot_spectrum(const Planes& spot, Extent raster);

/// Calls body(i, n) for the columns of a block that are within the spectrum: n is the place in Bins of column i.
template <class Body>
void for_columns(const SpectrumColumns& block, int columns, const Body& body) {
  const int count = std::min(SpectrumColumns::count, columns - block.first);
  for (int i = 0; i < count; ++i) {
    body(i, static_cast<std::size_t>(block.first + i) * static_cast<std::size_t>(block.height));
  }
}

/// Γ_cd(v) = Cov(Y_c(x + v), Y_d(x)) for all lags v between pixels of a box, without the nugget.
///
/// On the plane Γ is the aperiodic autocorrelation of the spot. Only lags smaller than the box matter, so it is cut off
/// there and wrapped around a torus of the smallest good size >= 2 box − 1: a hole of 100 x 100 in a large picture
/// needs transforms of 216 x 216. A periodic field whose torus is smaller than that is taken on its torus.
class BoxCovariance {
 public:
  using Workspace = BoxTransform::Workspace;

  /// `torus` is the size of the torus of a periodic field; otherwise it is not read. Throws std::invalid_argument when
  /// the box is larger than it.
  BoxCovariance(const GaussianField& field, Extent torus, Extent box);

  Extent box() const { return transform_.box(); }
  Extent grid() const { return transform_.grid(); }
  int channels() const { return channels_; }
  std::size_t bytes() const;

  /// Replaces the planes, of size box(), by (Γ f)_c(x) = Σ_d Σ_y Γ_cd(x − y) f_d(y), y in the box: one forward and one
  /// inverse transform a channel and the product of a Hermitian matrix a frequency. The bits do not depend on the
  /// number of threads.
  void apply(Planes& fields, Workspace& workspace) const;

  /// `reach` is at most the box.
  CovarianceTable table(Extent reach) const;

 private:
  /// Γ_cd on the grid, lag (0, 0) first.
  Planes lags(int c, int d, Workspace& workspace) const;

  BoxTransform transform_;
  int channels_ = 0;
  /// Γ̂_cd / |grid|, c <= d in lexical order, laid out as Bins.
  std::vector<std::vector<double>> diagonal_;
  std::vector<Bins> off_diagonal_;
};

}  // namespace textonbench
