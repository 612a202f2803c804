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

}  // namespace textonbench
