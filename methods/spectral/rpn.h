// Random phase noise (RPN): the exemplar with its Fourier phase shifted at random.
//
//   Ẑ_c(ξ) = p̂_c(ξ) exp(iθ(ξ)),   θ odd, uniform, the same for every channel c,
//
// with p the periodic component of the exemplar (van Wijk 1991; Galerne, Gousseau, Morel 2011; Lectures 2022, "Random
// phase noise"). Modulus, mean and sample covariance of every output are exactly those of p.
#pragma once

#include "methods/exemplar_spot.h"

namespace textonbench {

/// added: θ is added to the exemplar's phase. replaced: θ replaces it in every channel, which loses the phase between
/// channels and so makes false colors ("wrong RPN" of the lectures; a control that color metrics must catch).
enum class PhaseRule { added, replaced };

struct RpnOptions {
  SpotSource component = SpotSource::periodic_component;
  PhaseRule phase = PhaseRule::added;
};

std::unique_ptr<Model> fit_rpn(const Exemplar& exemplar, const RpnOptions& options);

MethodEntry rpn_entry();

}  // namespace textonbench
