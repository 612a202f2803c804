// Discrete spot noise (DSN): the sum of copies of a spot at random points,
//
//   plane:  Y = m + λ^{−1/2} (Σ_i t(x − x_i) − λ Σ_x t(x))   on any window of Z²,
//   torus:  the same with t wrapped around it,
//
// with t = (p − m) / sqrt(|Ω|), p the periodic component of the exemplar, and x_i a Poisson process of λ impacts a
// pixel (van Wijk 1991; EUSIPCO 2014, Algorithm 1). Tends to ADSN as λ grows. Its support is the whole exemplar.
#pragma once

#include "methods/exemplar_spot.h"
#include "methods/spot/spot_noise.h"

namespace textonbench {

/// The exemplar's normalized spot as a texton of one kernel.
Texton exemplar_spot_texton(const Exemplar& exemplar, SpotSource source);

MethodEntry dsn_entry();

}  // namespace textonbench
