// Texton noise on a surface in space: start + Σ_i w_i (1 − (2/r) |<d_i, n>|)₊ h_{k_i}(<d_i, u1>, <d_i, u2>), d_i = y − x_i,
// over the impacts x_i of space, of kernels that are scaled already (methods/spot/surface_sum.h). On the plane, z = 0.
#include "plane.glsl"
#include "space.glsl"
#include "impact_grid.glsl"
#include "spline_kernel.glsl"
#include "spline_gradient.glsl"

uniform float start[CHANNELS];
uniform uvec2 key;       // low, high
uniform float thickness;  // r, pixels
// Side of the cubic cells, whole 2^−10 pixels and 32 bits below.
uniform int side_coarse;
uniform uint side_fraction;

// The impacts of methods/spot/surface_sum.h, to 2^−20 pixel.
uvec4 words_of_space(ivec3 cell, uint j) {
  return philox_block(key, uvec4(uint(cell.z), j, uint(cell.x), uint(cell.y)));
}

// Where a point is from the corner of a cell, pixels.
vec3 from_corner(SpacePoint point, ivec3 cell) {
  uvec3 high, low;
  umulExtended(uvec3(cell), uvec3(side_fraction), high, low);
  // Of a product with a signed number.
  ivec3 carried = ivec3(high) - ivec3(lessThan(cell, ivec3(0))) * int(side_fraction);
  ivec3 coarse = point.coarse - cell * side_coarse - carried;
  return vec3(coarse) * 0.0009765625 + (vec3(point.fine) - vec3(low >> 20)) * (1.0 / 4194304.0);
}

// What the sums need of a point.
struct SpaceKernel {
  KernelFilter filtered;
  vec3 reach;  // half sides of the box in the frame that holds the impacts of a point
};

SpaceKernel space_kernel(mat2 footprint) {
  KernelFilter filtered = kernel_filter(footprint);
  vec2 margin = vec2(filtered.margin) / float(plane_unit);
  return SpaceKernel(filtered, vec3(0.5 * vec2(coefficients + ORDER) + margin, 0.5 * thickness));
}

#if GRADIENTS
#define SPACE_SUMS inout vec4 sums[GROUPS], inout vec4 sums_x[GROUPS], inout vec4 sums_y[GROUPS]
#else
#define SPACE_SUMS inout vec4 sums[GROUPS]
#endif

// Adds an impact at the distance `away` of the point from it.
void add_space_impact(SpacePoint point, vec3 away, SpaceKernel kernel, int number, float weight, SPACE_SUMS) {
  vec3 local = away * point.frame;
  float height = weight * (1.0 - 2.0 / thickness * abs(local.z));
  if (abs(local.z) >= kernel.reach.z) return;
  vec2 offset = local.xy + 0.5 * vec2(coefficients - 1);
  vec2 from_first = offset + float(tap_offset) / float(plane_unit);
  vec2 margin = vec2(kernel.filtered.margin) / float(plane_unit);
  if (any(lessThan(from_first, -margin)) || any(greaterThanEqual(from_first, vec2(coefficients + ORDER) + margin))) {
    return;
  }
  vec2 whole = floor(from_first);
  ivec2 first = ivec2(whole) - ORDER;
  for (int g = 0; g < GROUPS; ++g) {
    int layer = number * GROUPS + g;
#if GRADIENTS
    vec4 along_x, along_y;
    sums[g] += height * kernel_gradient(first, from_first - whole, layer, along_x, along_y);
    sums_x[g] += height * along_x;
    sums_y[g] += height * along_y;
#else
    sums[g] += height * kernel_value(offset, first, from_first - whole, kernel.filtered, layer);
#endif
  }
}

void add_space_cell(SpacePoint point, ivec3 cell, vec3 corner, float side, SpaceKernel kernel, SPACE_SUMS) {
  uvec4 head = words_of_space(cell, 0u);
#if PROCESS == STRATIFIED
  uint count = 1u;
  float weight = head.x >> 31 != 0u ? -1.0 : 1.0;
#else
  ImpactGrid grid = ImpactGrid(uvec4(0u), ivec2(0), key, 1, ivec2(0, THRESHOLDS));
  uint count = impact_count(grid, CellWords(uvec4(0u), head));
  float weight = 1.0;
#endif
  for (uint i = 1u; i <= count; ++i) {
    uvec4 words = words_of_space(cell, i);
    uint number = 0u;
#if KERNELS > 1  // LLVM 15 crashes on the high part of a product with 1
    uint rest;
    umulExtended(words.w, uint(KERNELS), number, rest);
#endif
    vec3 away = corner - vec3(words.xyz >> 8) * (side * (1.0 / 16777216.0));
#if GRADIENTS
    add_space_impact(point, away, kernel, int(number), weight, sums, sums_x, sums_y);
#else
    add_space_impact(point, away, kernel, int(number), weight, sums);
#endif
  }
}

void add_space_impacts(SpacePoint point, mat2 footprint, SPACE_SUMS) {
  SpaceKernel kernel = space_kernel(footprint);
  float side = float(side_coarse) * 0.0009765625 + float(side_fraction) * (0.0009765625 / 4294967296.0);
  // A cell near the point, then the one that it lies in.
  ivec3 home = ivec3(floor(vec3(point.coarse) * 0.0009765625 / side));
  home += ivec3(floor(from_corner(point, home) / side));
  vec3 at = from_corner(point, home);
  mat3 absolute = mat3(abs(point.frame[0]), abs(point.frame[1]), abs(point.frame[2]));
  vec3 box = absolute * kernel.reach;
  ivec3 low = ivec3(floor((at - box) / side)), high = ivec3(floor((at + box) / side));
  // Half a cell along the axes of the frame.
  vec3 margin = 0.5 * side * vec3(dot(absolute[0], vec3(1.0)), dot(absolute[1], vec3(1.0)), dot(absolute[2], vec3(1.0)));
  for (int z = low.z; z <= high.z; ++z) {
    for (int y = low.y; y <= high.y; ++y) {
      for (int x = low.x; x <= high.x; ++x) {
        vec3 middle = (at - (vec3(x, y, z) + 0.5) * side) * point.frame;
        if (any(greaterThan(abs(middle), kernel.reach + margin))) continue;
        ivec3 cell = home + ivec3(x, y, z);
#if GRADIENTS
        add_space_cell(point, cell, from_corner(point, cell), side, kernel, sums, sums_x, sums_y);
#else
        add_space_cell(point, cell, from_corner(point, cell), side, kernel, sums);
#endif
      }
    }
  }
}

#if GRADIENTS
// Along u1 and u2, of the frame held fast: exact on the plane, and elsewhere to the kernel's side over the surface's
// radius of curvature.
void gradient_in_space(SpacePoint point, mat2 footprint, out float values[CHANNELS], out vec2 gradients[CHANNELS]) {
  vec4 sums[GROUPS], sums_x[GROUPS], sums_y[GROUPS];
  for (int g = 0; g < GROUPS; ++g) sums[g] = sums_x[g] = sums_y[g] = vec4(0.0);
  add_space_impacts(point, footprint, sums, sums_x, sums_y);
  for (int c = 0; c < CHANNELS; ++c) {
    values[c] = start[c] + sums[c / 4][c % 4];
    gradients[c] = vec2(sums_x[c / 4][c % 4], sums_y[c / 4][c % 4]);
  }
}

void texture_in_space(SpacePoint point, mat2 footprint, out float values[CHANNELS]) {
  vec2 gradients[CHANNELS];
  gradient_in_space(point, footprint, values, gradients);
}
#else
void texture_in_space(SpacePoint point, mat2 footprint, out float values[CHANNELS]) {
  vec4 sums[GROUPS];
  for (int g = 0; g < GROUPS; ++g) sums[g] = vec4(0.0);
  add_space_impacts(point, footprint, sums);
  for (int c = 0; c < CHANNELS; ++c) values[c] = start[c] + sums[c / 4][c % 4];
}
#endif

SpacePoint on_plane(PlanePoint point) { return SpacePoint(ivec3(point.coarse, 0), ivec3(point.fine, 0), mat3(1.0)); }

void texture_at(PlanePoint point, mat2 footprint, PlaneBox tile, out float values[CHANNELS]) {
  texture_in_space(on_plane(point), footprint, values);
}

#if GRADIENTS
void gradient_at(PlanePoint point, mat2 footprint, PlaneBox tile, out float values[CHANNELS],
                 out vec2 gradients[CHANNELS]) {
  gradient_in_space(on_plane(point), footprint, values, gradients);
}
#endif
