// The kernels of a spot noise: what its impacts sum.
#pragma once

#include <cstdint>
#include <vector>

#include "methods/base/image.h"

namespace textonbench {

/// K kernels h_1 … h_K of which every impact takes one, each with probability 1/K and then as sqrt(K) h_k. So the
/// cross-spectrum of the noise is P(ξ) = Σ_k ĥ_k(ξ) ĥ_k(ξ)*, whatever K, in the scaling of gaussian_model.h: the texton
/// of an exemplar u approximates its normalised spot (u − mean) / sqrt(|Ω|).
struct Texton {
  std::vector<Image> kernels;       ///< at least one; one size and number of channels for all; zero off the support
  std::int64_t support_pixels = 0;  ///< |S|, pixels of the support S: impacts have the mean number MNI = intensity |S|
  std::vector<double> mean;         ///< of the texture, one number a channel

  Extent extent() const { return kernels.front().extent(); }
  int channels() const { return kernels.front().channels(); }
};

/// Kernels of the plane: h_k(y) = Σ_j α_k(j) β^n(y1 − j1) β^n(y2 − j2) with the coefficients α_k(j) on a raster whose
/// pixel (0, 0) is j = (0, 0). An impact at x adds h_k(y − x). MNI = intensity · support_area.
struct SplineTexton {
  Texton coefficients;      ///< without a frame of zeros
  int order = 1;            ///< n, 0 to 5 (bspline.h)
  double support_area = 0;  ///< where a kernel may be other than zero, pixels²; (W + n)(H + n) for a rectangle
};

}  // namespace textonbench
