// Local random-phase noise by example (Gilet, Sauvage, Vanhoey, Dischler, Ghazanfarpour, SIGGRAPH Asia 2014).
//
// The exemplar's power spectrum (welch.h) is cut into strata of equal energy (strata.h), each of which is drawn as a
// layer of windowed cosines of random phase (wave_field.h).
//
// Amplitudes. A layer of J waves of amplitude A has the variance π I J A², I = ∫ r w² dr, so that A = sqrt(σ² / (π I
// J)) gives a stratum its own variance σ². The paper's equation 3 equates the energy of one window instead, and gives
// each layer a variance in proportion to σ² / Δ²: wide windows, those of the strongest bins, are attenuated.
#pragma once

#include <memory>
#include <vector>

#include "methods/base/welch.h"
#include "methods/method.h"
#include "methods/sparse/fixed_phases.h"
#include "methods/sparse/strata.h"
#include "methods/sparse/wave_field.h"

namespace textonbench {

/// corrected: every layer has its stratum's variance. printed: equation 3, scaled as a whole to the total variance.
/// parts: beyond the paper, every wave has the variance of the bins around its own part, which k-means makes of unequal
/// sizes.
enum class LrpAmplitude { corrected, printed, parts };

/// coherent: the waves of a bin share their phase, their colors drawn so that the mean is the bin's cross-spectrum.
/// independent: as in the paper, one noise for each axis of a decorrelated color space, which keeps the covariance of
/// the colors but not how they follow each other in space, at as many times the cost.
enum class LrpColor { coherent, independent };

struct LrpOptions {
  WelchOptions welch;
  StrataOptions strata;
  LrpAmplitude amplitude = LrpAmplitude::corrected;
  LrpColor color = LrpColor::coherent;
  bool even_variance = true;
  FixedPhaseOptions fixed;
  double footprint = 0;  ///< side of the pixels that the noise is filtered for; 0: its values at points
};

/// What a layer is made of.
struct LrpLayer {
  Stratum stratum;
  int axis = -1;  ///< of the color space, when colors are independent
};

struct LrpAnalysis {
  LrpOptions options;
  WelchSpectrum spectrum;
  std::vector<LrpLayer> layers;
  WaveField field;
  Pixel block;                       ///< corner of the block of the exemplar that the structure is taken from
  std::optional<FixedPhases> fixed;  ///< none when r = 0
};

/// A reason why an exemplar has no such analysis: a side below 32 pixels, blocks that do not fit, fewer cosines than
/// strata.
std::optional<std::string> refuse_lrp(const Exemplar& exemplar, const LrpOptions& options);

/// The seed is that of the clusters. Throws std::invalid_argument with the exemplar's name for one that is unusable or
/// refused, and for an overlap out of range.
LrpAnalysis analyze_lrp(const Exemplar& exemplar, const LrpOptions& options, Seed seed);

/// The model of an analysis: procedural, with a closed-form spectrum.
std::unique_ptr<Model> make_lrp(LrpAnalysis analysis);

/// The analysis of such a model; null for another one.
const LrpAnalysis* lrp_analysis_of(const Model& model);

/// Entry of the catalogue.
MethodEntry lrp_entry();

}  // namespace textonbench
