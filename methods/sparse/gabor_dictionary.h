// Powers of Gabor kernels of a few windows on a raster of frequencies, as sums and as correlations.
//
// Atom (b, F) is the power G_b(ξ − F) of the window of band b at the frequency F, a bin: the transform of its
// correlation ρ_b(v) / ρ_b(0), which is cut where the window is, with lags folded onto the raster. So it is what a
// noise of the band has on that raster to rounding, its tails included, and is nowhere negative. Sums over F are
// circular convolutions, one transform a band (Galerne, Lagae, Lefebvre, Drettakis, SIGGRAPH 2012, analyze so too).
// Centers F lie as far apart as an atom's standard deviation, or nearest below it: sums of such Gaussians are even to
// 1e-8.
#pragma once

#include <span>
#include <vector>

#include "methods/base/fft.h"
#include "methods/base/image.h"
#include "methods/sparse/gabor_field.h"

namespace textonbench {

/// Images of frequencies hold the whole plane: bin (kx, ky) is pixel (kx, ky), kx = 0 … W − 1; they are even,
/// u(k) = u(−k).
class GaborDictionary {
 public:
  /// At most Image::max_channels windows, with xy = 0. Throws std::invalid_argument otherwise.
  GaborDictionary(Extent raster, std::span<const GaborWindow> windows);

  Extent raster() const { return raster_; }
  int bands() const { return static_cast<int>(correlation_.size()); }
  /// Σ_b,F c_b(F) G_b(ξ − F) of an image of a channel a band.
  Image sum(const Image& coefficients) const;
  /// Σ_ξ r(ξ) G_b(ξ − F), a channel a band.
  Image correlate(const Image& residual) const;
  /// Σ_ξ Z(ξ) G_b(ξ − F) of a band, for a Hermitian Z.
  Spectrum correlate(const Spectrum& values, int band) const;
  /// Whether (kx, ky), 0 <= kx < W, 0 <= ky < H, is a center of a band.
  bool is_center(int band, int kx, int ky) const;
  /// sqrt(Σ_ξ G_b²).
  double norm(int band) const { return norms_[static_cast<std::size_t>(band)]; }

 private:
  Extent raster_;
  std::vector<Image> correlation_;  ///< ρ_b(v) / ρ_b(0), lags modulo the raster
  std::vector<double> norms_;
  std::vector<Extent> spacing_;  ///< of centers, bins
};

}  // namespace textonbench
