// The power that Gabor noise by example is fitted to.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "methods/base/exemplar.h"
#include "methods/base/fft.h"
#include "methods/base/image.h"

namespace textonbench {

/// Frequencies are the bins of a raster; sums over its whole plane are covariances of colors.
struct GaborTarget {
  std::vector<double> mean;
  std::vector<Spectrum> products;  ///< P_cd / |Ω|, d <= c, at color_pair_of(c, d), scaled as in gaussian_model.h
  Image power;                     ///< its trace on the whole plane, even; zero at frequency zero
  double scatter = 1;              ///< variance of a bin as a part of its square, of channels that are alike

  Extent raster() const { return power.extent(); }
  int channels() const { return static_cast<int>(mean.size()); }
  /// Covariance of the colors.
  Eigen::MatrixXd covariance() const;
};

/// The raster of an exemplar's frequencies: its own when its sides are at most `side`, else that of blocks of the
/// largest power of two that is at most `side` and less than its sides.
Extent gabor_raster(Extent exemplar, int side);

/// The periodogram of the periodic component of an exemplar, or the mean over its blocks as in welch.h. Throws
/// std::invalid_argument for an unusable exemplar and one of a single color. side >= 8.
GaborTarget gabor_target(const Exemplar& exemplar, int side);

}  // namespace textonbench
