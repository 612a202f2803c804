// A stationary Gaussian field with the law that a picture has where it is known.
#pragma once

#include <vector>

#include "methods/base/image.h"
#include "methods/base/mask.h"

namespace textonbench {

/// Real double-precision raster of several planes without padding: channel c, row y at data[(c * height + y) * width].
struct Planes {
  Planes() = default;
  Planes(Extent size, int number)
      : extent(size), channels(number), data(static_cast<std::size_t>(size.area() * number)) {}

  double* row(int channel, int y) { return data.data() + (std::int64_t{channel} * extent.height + y) * extent.width; }
  const double* row(int channel, int y) const {
    return data.data() + (std::int64_t{channel} * extent.height + y) * extent.width;
  }

  Extent extent;
  int channels = 0;
  std::vector<double> data;
};

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

/// Γ_cd(0) = Σ_x t_c(x) t_d(x), without the nugget, at c * channels + d.
std::vector<double> variances(const GaussianField& field);

}  // namespace textonbench
