// Power spectrum in bins of frequency, against the target's.
//
// The power is summed over channels (the trace of the cross-spectrum) and over bins: rings of half an octave,
// radii √½ · 2^{−j/2} cycles a pixel, the disc of radius 2 / min(W, H) or a little more being one ring, times 8
// orientations, sectors of π/8 modulo π of which one is centered on each axis. Frequency zero is left out.
//
// On a torus the power is the periodogram |û|² / |Ω|. Other samples are multiplied by a Hann window w first,
// w(x) = sin²(π (x + 1/2) / W) along each side, and the power is divided by Σ w². The target's power in a bin is the
// exact expectation of the same quantity: Σ_v (w ⋆ w)(v) tr Γ(v) exp(−2πi <ξ, v>) / Σ w² with a window.
#pragma once

#include <memory>

#include "experiments/metrics/metric.h"

namespace textonbench {

/// Mean over bins of |10 log₁₀(power of the sample set / power of the target)|, in dB, over the bins that hold at least
/// 0.1 % of the target's power. 20 |log₁₀ a| for a contrast of a times the target's; for the exact law about 3.5 dB /
/// sqrt(independent frequencies in a bin · samples). A bin that the samples leave empty counts 100 dB.
std::unique_ptr<SampleMetric> log_spectral_distance(const Target& target, const Domain& domain, Seed seed);

}  // namespace textonbench
