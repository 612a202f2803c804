// Exemplars that the program draws itself, each a periodic Gaussian field whose law is known exactly: color ones, and a
// stack of maps.
//
// On a torus Ω of 256 x 256 pixels, with three independent standard white noises w_k,
//
//   u_c = m_c + Σ_k M_ck (s * w_k),   P(ξ) = ŝ(ξ)² M Mᵀ   (the cross-spectrum, scaled as in gaussian_model.h),
//
// where ŝ >= 0 is the scalar spectrum of the exemplar with ŝ(0) = 0 and (1/|Ω|) Σ ŝ² = 1, and M its mixing, so that
// M Mᵀ is the covariance of the channels. P has rank three at every frequency where ŝ > 0, the full one for colors,
// while the Gaussian model of an exemplar that is read from a picture has rank one.
//
// Means lie in [0.45, 0.55] and standard deviations are at most 0.09, so [0, 1] begins 5 standard deviations away: a
// sample leaves it with probability below 6e-7, which is 0.12 samples an image. Nothing is clamped.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "methods/base/gaussian_model.h"
#include "methods/base/image.h"
#include "methods/base/image_maps.h"
#include "methods/base/random.h"

namespace textonbench {

struct ProceduralExemplar {
  std::string_view name;
  std::string_view title;           ///< "annulus of frequencies around 1/12 cycles a pixel"
  Seed seed;                        ///< of the one picture that stands under that name
  std::vector<ImageMap> maps = {};  ///< of a stack
};

constexpr Extent procedural_extent{256, 256};

/// Number of the definition of all of them: raised whenever a law, or how a seed draws it, changes. Rounding, which
/// differs between processors, is no change. With name and seed it stands for the SHA-256 of a file.
constexpr int procedural_definition = 1;

/// white_noise, ring, oriented_lobe, power_law; and color_and_height, the color map of which grows darker and redder
/// with the height.
std::span<const ProceduralExemplar> procedural_exemplars();

/// A sample of the law of that name. Throws std::invalid_argument for an unknown one, as do the functions below.
Image draw_procedural(std::string_view name, Seed seed);

/// Mean of each channel.
std::vector<double> known_mean(std::string_view name);

/// P(ξ) in three factors, ĥ_k = ŝ (M_1k, M_2k, …).
CrossSpectrum known_spectrum(std::string_view name);

}  // namespace textonbench
