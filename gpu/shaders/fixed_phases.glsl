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

// Coordinates of the structure in 2^−22 pixel, modulo 2^32: periods are powers of two of at most 1024 pixels.
void add_block(ivec2 block, uvec2 offset, float weight, inout float values[CHANNELS]) {
  int across = structure_period / block_side;
  block &= across - 1;
  uint at = structure_first +
            uint((block.y * across + block.x) * structure_cosines) * uint(1 + 2 * CHANNELS);
  uvec2 turns = offset * uint(1024 / block_period);
  for (int j = 0; j < structure_cosines; ++j) {
    uint bin = table(at);
    int kx = bitfieldExtract(int(bin), 0, 16), ky = bitfieldExtract(int(bin), 16, 16);
    vec2 wave = weight * unit_wave(uint(kx) * turns.x + uint(ky) * turns.y);
    for (int c = 0; c < CHANNELS; ++c) {
      values[c] += table_float(at + uint(1 + 2 * c)) * wave.x - table_float(at + uint(2 + 2 * c)) * wave.y;
    }
    at += uint(1 + 2 * CHANNELS);
  }
}

void add_place(uvec2 place, float weight, inout float values[CHANNELS]) {
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
  vec2 share = 0.5 - 0.5 * cos(3.14159265358979 * (vec2(from - block * side) / float(side)));
  for (int i = 0; i < 4; ++i) {
    uvec2 next = uvec2(i & 1, i >> 1);
    float part = (next.x == 1u ? share.x : 1.0 - share.x) * (next.y == 1u ? share.y : 1.0 - share.y);
    if (part <= 0.0) continue;
    add_block(ivec2(block + next), place - (block + next) * side + margin, weight * part, values);
  }
}

float turbulent(PlanePoint point, uint axis) {
  float sum = 0.0;
  for (uint l = 0u; l < uint(TURBULENT); ++l) {
    float values[CHANNELS];
    for (int c = 0; c < CHANNELS; ++c) values[c] = 0.0;
    add_layer(layer_at(uint(LAYERS) + axis * uint(TURBULENT) + l), point, values);
    sum += abs(values[0]);
  }
  return turbulence_scale * (sum - turbulence_mean);
}

// Part of the neighbor at a place in a block of random placement, in its sides, and which side it is on.
float blend(float at, out int neighbor) {
  float near = min(at, 1.0 - at);
  neighbor = at < 0.5 ? -1 : 1;
  float t = 0.5 - 6.0 * near;
  return t <= 0.0 ? 0.0 : t * t * (3.0 - 2.0 * t);
}

void add_structure(PlanePoint point, inout float values[CHANNELS]) {
  if (TURBULENT > 0) point = moved(point, vec2(turbulent(point, 0u), turbulent(point, 1u)));
  uvec2 place = uvec2(point.coarse) * 4096u + uvec2(point.fine) + uvec2(structure_base) * 4194304u;
  if (placement == 0) {
    add_place(place, 1.0, values);
    return;
  }
  int side = structure_period * (plane_unit / 2);
  ivec2 from_start = point.coarse + placement_start * plane_unit;
  ivec2 block = ivec2(floor_division(from_start.x, side), floor_division(from_start.y, side));
  vec2 at = (vec2(from_start - block * side) + vec2(point.fine) / 4096.0) / float(side);
  ivec2 neighbor;
  vec2 part = vec2(blend(at.x, neighbor.x), blend(at.y, neighbor.y));
  for (int i = 0; i < 4; ++i) {
    ivec2 next = ivec2(i & 1, i >> 1);
    float weight = (next.x == 1 ? part.x : 1.0 - part.x) * (next.y == 1 ? part.y : 1.0 - part.y);
    if (weight <= 0.0) continue;
    ivec2 cell = block + next * neighbor;
    uvec4 counter = uvec4(add_signed(placement_base.xy, cell.x), add_signed(placement_base.zw, cell.y));
    uvec4 words = philox_block(placement_key, counter);
    uvec2 shift, low;
    umulExtended(words.xy, uvec2(uint(structure_period)), shift, low);
    add_place(place + shift * 4194304u, weight, values);
  }
}
