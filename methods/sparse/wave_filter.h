// Local random-phase noise seen through pixels of some size (Gilet et al., SIGGRAPH Asia 2014, section 6.4).
//
// Frequency clamping leaves waves out that a pixel cannot show (Norton, Rockwood and Skolmoski, SIGGRAPH 1982). Here a
// wave has what the mean over a square pixel leaves of it up to the first zero of that response, and nothing from
// there on. Windows are not filtered: where they are narrower than a pixel, what leaks from their waves to other
// frequencies is neither removed nor kept as it should be.
#pragma once

#include "methods/sparse/wave_field.h"

namespace textonbench {

/// Part of a wave of (kx, ky) / side cycles a pixel that squares of footprint x footprint pixels leave of it.
double box_response(int kx, int ky, double side, double footprint);

/// Clamps all layers of a field, whose random numbers stay as they are. footprint >= 0; 0 changes nothing.
void clamp_frequencies(double footprint, WaveField& field);

}  // namespace textonbench
