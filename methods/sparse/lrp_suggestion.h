// How much structure a texture needs: the paper leaves r to its user (Gilet et al., SIGGRAPH Asia 2014, section 6.3).
//
// What Gaussian noise lacks is the exemplar's non-Gaussianity: skewness and excess kurtosis of its values and of their
// differences over 1, 2, 4 and 8 pixels along both axes, of the mean of the channels. Phases of a block are randomized
// outside of the strongest bins that hold r of the power; with e(r) the squared distance of these numbers from the
// block's own, the part that survives is 1 − e(r) / e(0).
#pragma once

#include <vector>

#include "methods/base/exemplar.h"
#include "methods/base/random.h"
#include "methods/base/welch.h"

namespace textonbench {

struct StructureSuggestion {
  double ratio = 0;              ///< the least r of those tried with half of the non-Gaussianity: 0 when there is none
  bool gaussian = false;         ///< e(0) is within twice what two random phases of the same block differ by
  double distance = 0;           ///< e(0)
  double chance = 0;             ///< mean squared distance of the numbers of two random phases
  std::vector<double> ratios;    ///< 0, 1/20, …, 1
  std::vector<double> survival;  ///< at each of them
};

/// Means over 8 draws of random phases. Throws std::invalid_argument like analyze_lrp().
StructureSuggestion suggest_structure(const Exemplar& exemplar, const WelchOptions& welch, Seed seed);

}  // namespace textonbench
