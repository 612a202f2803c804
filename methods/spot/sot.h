// Method "sot": noise of a synthesis-oriented texton, EUSIPCO 2014.
#pragma once

#include <vector>

#include "methods/exemplar_spot.h"
#include "methods/spot/alternating_projections.h"
#include "methods/spot/color_correction.h"

namespace textonbench {

enum class SotStart { random_phase, white };

struct SotOptions {
  SpotSource component = SpotSource::periodic_component;
  SotStart start = SotStart::random_phase;
  ProjectionOptions projections;
  ColorCorrection color_correction = ColorCorrection::none;
};

/// The options "iterations", "tolerance" and "initialization" (random_phase|white), and the start that was chosen.
std::vector<ParamSpec> projection_params();
ProjectionOptions projection_options(const Params& params);
SotStart sot_start_of(const Params& params);

/// Fits a texton of that support, or the coefficients of B-splines of projections.order on it; the seed draws its
/// start. Colors are corrected as those of the noise. Throws std::invalid_argument for an unusable exemplar, or as
/// alternate_projections and correct_colors do.
ProjectedTexton fit_sot(const Exemplar& exemplar, const Support& support, const SotOptions& options, Seed seed);
/// The same for a model of rank one; options.component is not read.
ProjectedTexton fit_sot(const GaussianModel& model, const Support& support, const SotOptions& options, Seed seed);

MethodEntry sot_entry();

}  // namespace textonbench
