// Fourier modulus and phase of samples on the exemplar's own torus, relative to the spot t of the target.
//
// With ŷ the spectrum of a sample (mean off, over √|Ω|), r(ξ) = Σ_c conj(t̂_c) ŷ_c / Σ_c |t̂_c|² is exp(iθ) for random
// phase noise and Ŵ / √|Ω| for asymptotic discrete spot noise. Looked at on one bin of each conjugate pair, off the
// self-conjugate bins, where the spot's power is above 1e-8 of its mean: below, float32 rounding takes over. All throw
// std::invalid_argument on another domain.
#pragma once

#include <memory>

#include "experiments/metrics/metric.h"

namespace textonbench {

/// Mean over samples of max |‖ŷ_c| − |t̂_c‖ / max |t̂_c| over bins and channels: 0 for RPN up to float32 rounding.
std::unique_ptr<SampleMetric> modulus_error(const Target& target, const Domain& domain, Seed seed);

/// Mean over samples of √n sup |F_n − F| for the n values of |r| against F(r) = 1 − exp(−r²), the Rayleigh law of mean
/// square 1. √(π/2) ln 2 = 0.869 on average for the exact law (standard deviation 0.260 a sample), about 0.63 √n for a
/// constant modulus.
std::unique_ptr<SampleMetric> rayleigh_distance(const Target& target, const Domain& domain, Seed seed);

/// The same of arg r against the uniform law on (−π, π].
std::unique_ptr<SampleMetric> phase_uniformity(const Target& target, const Domain& domain, Seed seed);

}  // namespace textonbench
