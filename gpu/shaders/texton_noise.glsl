// Texton noise: start + Σ_i ε_i h_{k_i}(y − x_i) over the impacts x_i of the plane, of kernels that are scaled already
// (methods/spot/spline_noise.h). SHARED_MEAN adds the mean of a mixture, first + ρ (second − first).
#include "plane.glsl"
#ifdef SHARE
#include "share.glsl"
#endif
#include "recipe_grid.glsl"
#include "spline_kernel.glsl"
#include "spline_gradient.glsl"
#include "impact_sum.glsl"

uniform float start[CHANNELS];
#ifdef SHARED_MEAN
uniform float first_mean[CHANNELS];
uniform float mean_change[CHANNELS];
#endif

void texture_at(PlanePoint point, mat2 footprint, PlaneBox tile, out float values[CHANNELS]) {
  vec4 sums[GROUPS];
  for (int g = 0; g < GROUPS; ++g) sums[g] = vec4(0.0);
  add_impacts(point, footprint, tile, sums);
  for (int c = 0; c < CHANNELS; ++c) values[c] = start[c] + sums[c / 4][c % 4];
#ifdef SHARED_MEAN
  float rho = share_at(point);
  for (int c = 0; c < CHANNELS; ++c) values[c] += first_mean[c] + rho * mean_change[c];
#endif
}

#if GRADIENTS
// Impact by impact, in compute shaders too.
void gradient_at(PlanePoint point, mat2 footprint, PlaneBox tile, out float values[CHANNELS],
                 out vec2 gradients[CHANNELS]) {
  vec4 sums[GROUPS], sums_x[GROUPS], sums_y[GROUPS];
  for (int g = 0; g < GROUPS; ++g) sums[g] = sums_x[g] = sums_y[g] = vec4(0.0);
  ImpactGrid grid = recipe_grid();
  CellRange range = cells_of(grid, reaching(PlaneBox(point.coarse, point.coarse), ivec2(0)));
  for (int y = range.low.y; y <= range.high.y; ++y) {
    for (int x = range.low.x; x <= range.high.x; ++x) {
      ivec2 cell = ivec2(x, y);
      CellWords open = open_cell(grid, cell);
      uint count = impact_count(grid, open);
      for (uint i = 0u; i < count; ++i) {
        add_sloped_impact(point, impact_on_plane(grid, cell, next_impact(grid, open, i)), sums, sums_x, sums_y);
      }
    }
  }
  for (int c = 0; c < CHANNELS; ++c) {
    values[c] = start[c] + sums[c / 4][c % 4];
    gradients[c] = vec2(sums_x[c / 4][c % 4], sums_y[c / 4][c % 4]);
  }
#ifdef SHARED_MEAN
  float rho = share_at(point);
  float slope = share_slope_at(point);
  for (int c = 0; c < CHANNELS; ++c) {
    values[c] += first_mean[c] + rho * mean_change[c];
    gradients[c].x += slope * mean_change[c];
  }
#endif
}
#endif
