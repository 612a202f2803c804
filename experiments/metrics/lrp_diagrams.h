// Pictures of what local random-phase noise is made of (Gilet et al., SIGGRAPH Asia 2014, figures 4, 5 and 9).
//
// Spectra have frequency zero in the middle. Colors tell sets of bins apart; of a gray exemplar they are shades.
#pragma once

#include <cstdint>

#include "methods/method.h"

namespace textonbench {

/// power: logarithm of Welch's spectrum, 60 dB from black to white. strata: a color each. eroded: the bins that are
/// drawn from. parts: those of each part of a stratum in a color. windows: |ŵ|² of the windows around one draw of bins.
/// layer_1 to layer_4: a sample of one stratum alone. variance: local variance over its mean, 1 is mid-gray, of windows
/// whose lattices start at the origin. structure: the structure image. reduced: of few cosines. residual: mid-gray plus
/// 32 times what that lacks.
enum class LrpDiagram {
  power,
  strata,
  eroded,
  parts,
  windows,
  layer_1,
  layer_2,
  layer_3,
  layer_4,
  variance,
  structure,
  reduced,
  residual
};

/// T x T pixels; samples have the size of the domain. Throws std::invalid_argument for a model of another kind, for a
/// stratum that there is not and for a structure where there is none.
Image lrp_diagram(const Model& model, LrpDiagram diagram, const Domain& domain);

}  // namespace textonbench
