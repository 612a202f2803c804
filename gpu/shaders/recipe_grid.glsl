// The grid of impacts of a recipe that has one, whose base is a corner of its cells. THRESHOLDS is the number of
// poisson_thresholds().
#include "impact_grid.glsl"

uniform uvec4 base_cell;  // 64-bit coordinates of the base's cell: x low, x high, y low, y high
uniform uvec2 key;        // low, high
uniform int cell_side;    // in 2^−10 pixel

ImpactGrid recipe_grid() {
#if PROCESS == POISSON || PROCESS == SIGNED_POISSON
  ivec2 all = ivec2(0, THRESHOLDS);
#else
  ivec2 all = ivec2(0);
#endif
  return ImpactGrid(base_cell, ivec2(0), key, cell_side, all);
}
