// Cross-spectra by averaged periodograms (Welch, IEEE Trans. Audio Electroacoustics 15, 1967).
#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

#include "methods/base/fft.h"
#include "methods/base/image.h"
#include "methods/base/mask.h"

namespace textonbench {

/// none: blocks as they are, whose borders leak into the cross; hann: sin², whose lines are three bins wide.
enum class Taper { none, hann };

struct WelchOptions {
  int side = 0;          ///< of the square blocks, a power of two; 0: the largest one below the sides of the image
  double overlap = 0.5;  ///< part of a side that neighboring blocks share at least, in [0, 1)
  Taper taper = Taper::hann;
};

/// The largest power of two strictly below the smaller side of an image.
int welch_side(Extent size);

/// Mean of the periodograms of blocks that are spread evenly over the image, its mean taken off first:
///
///   P(k) = mean over blocks of û û* / Σ taper²,
///
/// in the scaling of gaussian_model.h on a torus of side x side: (1 / side²) Σ_k P(k) is the covariance of the colors.
class WelchSpectrum {
 public:
  /// Throws std::invalid_argument for a side that is no power of two in [8, smaller side of u], an overlap out of range
  /// or more than 65536 blocks.
  WelchSpectrum(const Image& u, const WelchOptions& options);

  int side() const { return products_.front().raster().width; }
  int channels() const { return channels_; }
  const std::vector<double>& mean() const { return mean_; }
  /// Corners of the blocks, row after row.
  const std::vector<Pixel>& blocks() const { return blocks_; }
  /// P at the bin (kx, ky), 0 <= kx <= side / 2, 0 <= ky < side: Hermitian, channels x channels.
  Eigen::MatrixXcd at(int kx, int ky) const;
  /// Its trace.
  double power(int kx, int ky) const;

 private:
  std::size_t pair(int c, int d) const {
    return static_cast<std::size_t>(c) * (static_cast<std::size_t>(c) + 1) / 2 + static_cast<std::size_t>(d);
  }

  int channels_;
  std::vector<double> mean_;
  std::vector<Pixel> blocks_;
  std::vector<Spectrum> products_;  // P_cd, d <= c, is number c (c + 1) / 2 + d
};

}  // namespace textonbench
