// A stationary Gaussian field with the law that a picture has where it is known.
#pragma once

#include <vector>

#include "methods/base/double_fft.h"
#include "methods/base/image.h"
#include "methods/base/mask.h"

namespace textonbench {

/// Y_c = m_c + t_c * W + ν N_c on Z², or t_c ⊛ W on a torus: ADSN with the spot t, white noise W shared by all
/// channels, and white noise N of each channel of variance ν² (Lectures 2022, inpainting).
struct GaussianField {
  std::vector<double> mean;    ///< m
  Planes spot;                 ///< t
  bool periodic = false;       ///< on the torus of the picture's size
  double nugget_variance = 0;  ///< ν², in square units of the picture

  int channels() const { return spot.channels; }
};

/// m the mean over the known pixels, t = (u − m) / sqrt(#known) there and 0 at the missing ones, whose samples are not
/// read (Lectures 2022; Galerne and Leclaire 2017). Throws std::invalid_argument for sizes that differ, fewer known
/// pixels than `least_known_pixels`, a known sample that is not finite, or known pixels without variation.
GaussianField estimate_field(const Image& u, const Mask& missing);

/// Estimating a law of second order from fewer says nothing.
inline constexpr std::int64_t least_known_pixels = 64;

/// Variance of a pixel without the nugget, Σ_x t_c(x)², mean over the channels.
double mean_variance(const GaussianField& field);

}  // namespace textonbench
