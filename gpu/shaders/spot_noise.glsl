// Spot noise of Z²: start + Σ_i ε_i h_{k_i}(y − x_i) over the impacts x_i of the plane, of kernels that are scaled already
// (methods/spot/spot_noise.h), at the pixel nearest to a point.
#include "plane.glsl"
#include "spot_impacts.glsl"
#include "spline_kernel.glsl"
#include "impact_sum.glsl"

uniform float start[CHANNELS];

ivec2 nearest_pixel(ivec2 coarse) { return (coarse + plane_unit / 2) & ~(plane_unit - 1); }

void texture_at(PlanePoint point, mat2 footprint, PlaneBox tile, out float values[CHANNELS]) {
  vec4 sums[GROUPS];
  for (int g = 0; g < GROUPS; ++g) sums[g] = vec4(0.0);
  PlaneBox pixels = PlaneBox(nearest_pixel(tile.low), nearest_pixel(tile.high));
  add_impacts(PlanePoint(nearest_pixel(point.coarse), ivec2(0)), footprint, pixels, sums);
  for (int c = 0; c < CHANNELS; ++c) values[c] = start[c] + sums[c / 4][c % 4];
}
