// Random half spectra, made while they are transformed, multiplied by a model's spot: the common core of RPN and ADSN
// on a torus.
#pragma once

#include "methods/base/gaussian_model.h"
#include "methods/base/random.h"

namespace textonbench {

enum class HermitianNoise {
  /// Spectrum of a unit-variance Gaussian white noise W, over sqrt(|Ω|): E|Ŵ|² = |Ω|.
  gaussian,
  /// Unit modulus, uniform phase: odd, and 0 or π with equal probability on self-conjugate bins.
  phase,
};

/// Torus image with spectrum sqrt(|Ω|) t̂_c(ξ) N(ξ), one noise N for all channels c, plus the model's mean. `model` has
/// one factor t̂. The noise of a
/// bin depends on its place alone, so bins can be made in any order and by any number of threads.
Image modulate(const GaussianModel& model, const Stream& stream, HermitianNoise noise);

}  // namespace textonbench
