// The structure of local random-phase noise: methods/sparse/structure.h, fixed_phases.h.
uniform uint structure_first;    // place in the table of the first block: `structure_cosines` times kx and ky in 16 bits, …
uniform int structure_cosines;   // … then of each its channels
uniform int structure_period;    // of the structure, pixels
uniform int block_side;          // pixels; structure_period when it is not cut
uniform int block_period;        // of a block's cosines, pixels
uniform ivec2 structure_base;    // the base modulo the period, pixels
uniform float turbulence_scale;  // pixels of a unit of Σ |n|
uniform float turbulence_mean;   // of Σ |n|
uniform int placement;
uniform uvec2 placement_key;
uniform uvec4 placement_base;  // 64-bit numbers of the base's block of random placement: x low, x high, y low, y high
uniform ivec2 placement_start;   // of the base in that block, pixels

// A weight and its gradient.
struct Weight {
  float value;
  vec2 slope;
};

Weight times(Weight a, Weight b) { return Weight(a.value * b.value, a.value * b.slope + b.value * a.slope); }

// Of a share along each axis, and its derivative there: that of the neighbor where next is 1, else the rest.
Weight part_of(ivec2 next, vec2 share, vec2 slope) {
  float x = next.x == 1 ? share.x : 1.0 - share.x, y = next.y == 1 ? share.y : 1.0 - share.y;
  return Weight(x * y, vec2(next.x == 1 ? slope.x : -slope.x, next.y == 1 ? slope.y : -slope.y) * vec2(y, x));
}

// Coordinates of the structure in 2^−22 pixel, modulo 2^32: periods are powers of two of at most 1024 pixels.
void add_block(ivec2 block, uvec2 offset, Weight weight, inout float values[CHANNELS]) {
  int across = structure_period / block_side;
  block &= across - 1;
  uint at = structure_first +
            uint((block.y * across + block.x) * structure_cosines) * uint(1 + 2 * CHANNELS);
  uvec2 turns = offset * uint(1024 / block_period);
  for (int j = 0; j < structure_cosines; ++j) {
    uint bin = table(at);
    int kx = bitfieldExtract(int(bin), 0, 16), ky = bitfieldExtract(int(bin), 16, 16);
    vec2 wave = unit_wave(uint(kx) * turns.x + uint(ky) * turns.y);
    vec2 angular = 2.0 * pi / float(block_period) * vec2(kx, ky);
    add_term(at + 1u, wave, weight.value, weight.slope, angular, values);
    at += uint(1 + 2 * CHANNELS);
  }
}

void add_place(uvec2 place, Weight weight, inout float values[CHANNELS]) {
  const uint pixel = 4194304u;
  place &= uint(structure_period) * pixel - 1u;
  if (block_side == structure_period) {
    add_block(ivec2(0), place, weight, values);
    return;
  }
  uint side = uint(block_side) * pixel;
  uint margin = block_side == 1 ? 0u : side / 2u;
  uint middle = (side - pixel) / 2u;
  // Blocks are numbered modulo the period, as are coordinates.
  uvec2 from = (place - middle) & (uint(structure_period) * pixel - 1u);
  uvec2 block = from / side;
  vec2 angle = pi * (vec2(from - block * side) / float(side));
  vec2 share = 0.5 - 0.5 * cos(angle);
  vec2 slope = 0.5 * pi / float(block_side) * sin(angle);
  for (int i = 0; i < 4; ++i) {
    uvec2 next = uvec2(i & 1, i >> 1);
    Weight part = part_of(ivec2(next), share, slope);
    if (part.value <= 0.0) continue;
    add_block(ivec2(block + next), place - (block + next) * side + margin, times(weight, part), values);
  }
}

// A displacement along an axis; `slope` is its gradient, of shaders that have some.
float turbulent(PlanePoint point, uint axis, out vec2 slope) {
  float sum = 0.0;
  slope = vec2(0.0);
  for (uint l = 0u; l < uint(TURBULENT); ++l) {
    float values[CHANNELS];
    for (int c = 0; c < CHANNELS; ++c) values[c] = 0.0;
#if GRADIENTS
    for (int c = 0; c < CHANNELS; ++c) slopes[c] = vec2(0.0);
#endif
    add_layer(layer_at(uint(LAYERS) + axis * uint(TURBULENT) + l), point, values);
    sum += abs(values[0]);
#if GRADIENTS
    slope += turbulence_scale * sign(values[0]) * slopes[0];
#endif
  }
  return turbulence_scale * (sum - turbulence_mean);
}

// Part of the neighbor at a place in a block of random placement, in its sides, its derivative, and which side it is on.
float blend(float at, out float slope, out int neighbor) {
  float near = min(at, 1.0 - at);
  neighbor = at < 0.5 ? -1 : 1;
  float t = max(0.5 - 6.0 * near, 0.0);
  slope = 36.0 * t * (1.0 - t) * float(neighbor);
  return t * t * (3.0 - 2.0 * t);
}

void add_placed(PlanePoint point, inout float values[CHANNELS]) {
  uvec2 place = uvec2(point.coarse) * 4096u + uvec2(point.fine) + uvec2(structure_base) * 4194304u;
  if (placement == 0) {
    add_place(place, Weight(1.0, vec2(0.0)), values);
    return;
  }
  int side = structure_period * (plane_unit / 2);
  ivec2 from_start = point.coarse + placement_start * plane_unit;
  ivec2 block = ivec2(floor_division(from_start.x, side), floor_division(from_start.y, side));
  vec2 at = (vec2(from_start - block * side) + vec2(point.fine) / 4096.0) / float(side);
  ivec2 neighbor;
  vec2 slope;
  vec2 share = vec2(blend(at.x, slope.x, neighbor.x), blend(at.y, slope.y, neighbor.y));
  slope *= 2.0 / float(structure_period);
  for (int i = 0; i < 4; ++i) {
    ivec2 next = ivec2(i & 1, i >> 1);
    Weight part = part_of(next, share, slope);
    if (part.value <= 0.0) continue;
    ivec2 cell = block + next * neighbor;
    uvec4 counter = uvec4(add_signed(placement_base.xy, cell.x), add_signed(placement_base.zw, cell.y));
    uvec4 words = philox_block(placement_key, counter);
    uvec2 shift, low;
    umulExtended(words.xy, uvec2(uint(structure_period)), shift, low);
    add_place(place + shift * 4194304u, part, values);
  }
}

void add_structure(PlanePoint point, inout float values[CHANNELS]) {
  if (TURBULENT == 0) {
    add_placed(point, values);
    return;
  }
#if GRADIENTS
  vec2 kept[CHANNELS] = slopes;
#endif
  vec2 slope_x, slope_y;
  vec2 displacement;
  displacement.x = turbulent(point, 0u, slope_x);
  displacement.y = turbulent(point, 1u, slope_y);
#if GRADIENTS
  for (int c = 0; c < CHANNELS; ++c) slopes[c] = vec2(0.0);
#endif
  add_placed(moved(point, displacement), values);
#if GRADIENTS
  for (int c = 0; c < CHANNELS; ++c) slopes[c] = kept[c] + slopes[c] + slopes[c].x * slope_x + slopes[c].y * slope_y;
#endif
}
