// The impacts of methods/spot/impacts.h on the plane, bit for bit: PROCESS is one of the numbers below and KERNELS the
// number of kernels. Places are whole pixels from the base.
#include "philox.glsl"
#include "plane_impact.glsl"

#define POISSON 0
#define STRATIFIED 2

uniform uvec4 base_cell;  // 64-bit coordinates of the cell that others are counted from: x low, x high, y low, y high
uniform ivec2 base_corner;  // its corner from the base, in 2^−10 pixel
uniform uvec2 key;        // of the stream: low, high
uniform int cell_side;    // in 2^−10 pixel
uniform uvec2 refused;    // 2^64 modulo cell_side and modulo KERNELS

#if PROCESS == POISSON
#include "poisson_number.glsl"
#define CELL_STARTS
#endif

struct ImpactGrid {
  ivec2 corner;
  int side;
};

// From the corner of its cell, in 2^−10 pixel.
struct CellImpact {
  ivec2 place;
  int kernel;
  float weight;
};

// A reader of the words of a cell's stream.
struct CellWords {
  uvec2 key;
  uint next;   // number of the next word
  uint block;  // number of the block in `words`
  uvec4 words;
};

ImpactGrid recipe_grid() { return ImpactGrid(base_corner, cell_side); }

// Stream::child() of a number.
uvec2 child_key(uvec2 parent, uvec2 number) {
  return philox_block(parent ^ uvec2(0x75726573u, 0x74657874u), uvec4(number, 2u, 0u)).xy;
}

CellWords open_cell(ImpactGrid grid, ivec2 cell) {
  uvec2 row = child_key(key, add_signed(base_cell.zw, cell.y));
  return CellWords(child_key(row, add_signed(base_cell.xy, cell.x)), 0u, 0xFFFFFFFFu, uvec4(0u));
}

uint next_word(inout CellWords open) {
  uint block = open.next / 4u;
  if (block != open.block) {
    open.words = philox_block(open.key, uvec4(block, 0u, 0u, 0u));
    open.block = block;
  }
  uint word = open.words[open.next & 3u];
  ++open.next;
  return word;
}

// RandomSequence::below(): the high word of the product of 64 random bits and the bound, which is below 2^31.
uint next_below(inout CellWords open, uint bound, uint refused_below) {
  uint result = 0u;
  bool is_refused = true;
  while (is_refused) {
    uint high_word = next_word(open);
    uint low_word = next_word(open);
    uint high, middle, carried, low, carry;
    umulExtended(high_word, bound, high, middle);
    umulExtended(low_word, bound, carried, low);
    middle = uaddCarry(middle, carried, carry);
    result = high + carry;
    is_refused = middle == 0u && low < refused_below;
  }
  return result;
}

int next_kernel(inout CellWords open) {
#if KERNELS == 1
  return 0;
#else
  return int(next_below(open, uint(KERNELS), refused.y));
#endif
}

// Of a cell that was opened just now; then goes on to the words of its impacts.
uint impact_count(ImpactGrid grid, inout CellWords open) {
#if PROCESS == STRATIFIED
  return 1u;
#else
  uint words;
  uint count = poisson_number(open.key, words);
  open.next = words;
  return count;
#endif
}

// Goes on to the words of impact i from those of impact 0. With several kernels each has three words, but for refused
// ones, one in 2^64 / KERNELS.
void skip_to_impact(ImpactGrid grid, inout CellWords open, uint i) { open.next += (KERNELS == 1 ? 1u : 3u) * i; }

CellImpact next_impact(ImpactGrid grid, inout CellWords open, uint i) {
#if PROCESS == STRATIFIED
  float weight = (next_word(open) & 1u) == 0u ? 1.0 : -1.0;
  ivec2 place;
  place.x = int(next_below(open, uint(grid.side), refused.x));
  place.y = int(next_below(open, uint(grid.side), refused.x));
#else
  float weight = 1.0;
  uint word = next_word(open);
  ivec2 place = ivec2(uvec2(word, word >> 16) << 10) & (grid.side - 1);
#endif
  return CellImpact(place, next_kernel(open), weight);
}

// At the pixel of its place.
PlaneImpact impact_on_plane(ImpactGrid grid, ivec2 cell, CellImpact impact) {
  ivec2 place = grid.corner + cell * grid.side + impact.place;
  return PlaneImpact(PlanePoint(place & ~(plane_unit - 1), ivec2(0)), impact.kernel, impact.weight);
}

// Cells whose impacts may have their pixels in a box.
CellRange cells_of(ImpactGrid grid, PlaneBox box) {
  return cells_in(PlaneBox(box.low, box.high + (plane_unit - 1)), grid.corner, grid.side);
}
