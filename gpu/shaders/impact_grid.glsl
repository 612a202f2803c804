// The impacts of methods/base/impact_grid.h, bit for bit, of any number of grids. PROCESS is one of the numbers below and
// KERNELS the number of kernels, those of all grids.
#include "philox.glsl"
#include "plane_impact.glsl"

#define POISSON 0
#define SIGNED_POISSON 1
#define STRATIFIED 2
#define PAPER 3

#if PROCESS == POISSON || PROCESS == SIGNED_POISSON
uniform usamplerBuffer thresholds;  // poisson_thresholds(), grid after grid
#endif
#if PROCESS == PAPER
uniform float cell_mean;  // impacts a cell
#endif

// Cells are counted from one of them, near the recipe's base.
struct ImpactGrid {
  uvec4 first_cell;  // its 64-bit coordinates: x low, x high, y low, y high
  ivec2 corner;      // its corner from the base, in 2^−10 pixel
  uvec2 key;         // low, high
  int side;          // in 2^−10 pixel
  ivec2 thresholds;  // those of the grid: from, to
};

// As it is drawn: x and y in 2^−24 cell sides.
struct CellImpact {
  uvec2 place;
  int kernel;
  float weight;
};

// Where the impacts of a cell come from: a block of its random words; or, in the paper's process, the two words that its
// number of impacts is made of and then the state of its generator.
struct CellWords {
  uvec4 cell;
  uvec4 words;
};

uvec4 block_of_cell(ImpactGrid grid, uvec4 cell, uint j) {
  return philox_block(uvec2(grid.key.x ^ j, grid.key.y), cell);
}

#if PROCESS == PAPER
uint wang_hash(uint s) {
  s = (s ^ 61u) ^ (s >> 16);
  s *= 9u;
  s ^= s >> 4;
  s *= 0x27D4EB2Du;
  return s ^ (s >> 15);
}

uint next_word(inout uint state) {
  state ^= state << 13;
  state ^= state >> 17;
  state ^= state << 5;
  return state;
}

// Of the angle 2π turn / 2^32, as in methods/base/portable_math.h.
float cosine(uint turn) {
  uint quarter = (turn + 0x20000000u) >> 30;
  float x = float(int(turn - (quarter << 30))) * 1.46291807926715968e-9;
  float x2 = x * x;
  float s = x + x * x2 * (-1.6666654611e-1 + x2 * (8.3321608736e-3 + x2 * -1.9515295891e-4));
  float c = 1.0 - 0.5 * x2 +
            x2 * x2 * (4.166664568298827e-2 + x2 * (-1.388731625493765e-3 + x2 * 2.443315711809948e-5));
  float a = (quarter & 1u) != 0u ? s : c;
  return ((quarter + 1u) & 2u) != 0u ? -a : a;
}

// In float32, where the processor has float64: another number where the rounding crosses a whole one.
uint paper_count(uint u, uint v) {
  float radius = sqrt(max(-2.0 * log(float(u) * (1.0 / 4294967296.0)), 0.0));
  return uint(max(floor(cell_mean + 0.5 + sqrt(cell_mean) * radius * cosine(v)), 0.0));
}
#endif

CellWords open_cell(ImpactGrid grid, ivec2 cell) {
  CellWords open;
  open.cell = uvec4(add_signed(grid.first_cell.xy, cell.x), add_signed(grid.first_cell.zw, cell.y));
#if PROCESS == PAPER
  uint state = wang_hash(1024u * (open.cell.z & 1023u) + (open.cell.x & 1023u) + grid.key.x);
  if (state == 0u) state = 1u;
  uint u = next_word(state);
  uint v = next_word(state);
  open.words = uvec4(u, v, state, 0u);
#else
  open.words = block_of_cell(grid, open.cell, 0u);
#endif
  return open;
}

// Of a cell that was opened just now.
uint impact_count(ImpactGrid grid, CellWords open) {
#if PROCESS == STRATIFIED
  return 1u;
#elif PROCESS == PAPER
  return paper_count(open.words.x, open.words.y);
#else
  // Thresholds at most the first word.
  int low = grid.thresholds.x;
  int high = grid.thresholds.y;
  while (low < high) {
    int middle = (low + high) / 2;
    if (texelFetch(thresholds, middle).x <= open.words.x) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return uint(low - grid.thresholds.x);
#endif
}

// Goes on to the words of impact i of a cell that was opened just now.
void skip_to_impact(ImpactGrid grid, inout CellWords open, uint i) {
#if PROCESS == PAPER
  for (uint k = 0u; k < 2u * i; ++k) next_word(open.words.z);
#elif PROCESS != STRATIFIED
  if (i > 0u && (i & 1u) == 0u) open.words = block_of_cell(grid, open.cell, i / 2u);
#endif
}

// Impact i, to be asked for in turn from 0 or from where skip_to_impact() went.
CellImpact next_impact(ImpactGrid grid, inout CellWords open, uint i) {
  uvec2 words;
  float weight = 1.0;
#if PROCESS == PAPER
  words.x = next_word(open.words.z);
  words.y = next_word(open.words.z);
#elif PROCESS == STRATIFIED
  words = open.words.zw;
  if (open.words.x >> 31 != 0u) weight = -1.0;
#else
  if ((i & 1u) != 0u) open.words = block_of_cell(grid, open.cell, (i + 1u) / 2u);
  words = (i & 1u) != 0u ? open.words.xy : open.words.zw;
#endif
#if PROCESS == SIGNED_POISSON
  if ((words.y & 1u) != 0u) weight = -1.0;
#endif
  uint fraction = (words.x & 255u) << 8 | (words.y & 255u);
  return CellImpact(words >> 8, int((fraction * uint(KERNELS)) >> 16), weight);
}

// Rounded down to 2^−22 pixel. With SHARE, its kernel is that of its place.
PlaneImpact impact_on_plane(ImpactGrid grid, ivec2 cell, CellImpact impact) {
  uvec2 high, low;
  umulExtended(impact.place, uvec2(grid.side), high, low);
  ivec2 corner = grid.corner + cell * grid.side;
  PlanePoint place = PlanePoint(corner + ivec2(high << 8 | low >> 24), ivec2(low >> 12) & 4095);
#ifdef SHARE
  impact.kernel = kernel_of_place(place);
#endif
  return PlaneImpact(place, impact.kernel, impact.weight);
}

// Cells that hold the points of a box.
CellRange cells_of(ImpactGrid grid, PlaneBox box) { return cells_in(box, grid.corner, grid.side); }
