// The kernels of GaborImpacts (methods/sparse/gabor_field.h), bit for bit: places, entries, phases and weights.
// FIXED_PHASE is the phase of all of them in 2^−32 turn where it is not drawn, UNIFORM_WEIGHT 1 where weights are uniform.
#include "plane.glsl"
#define KERNELS 1
#include "impact_grid.glsl"

uniform uvec4 base_place;       // of the base, 64-bit coordinates in 2^−22 pixel: x low, x high, y low, y high
uniform usamplerBuffer tables;  // BAND_WORDS a band, then what they point to

#define BAND_WORDS 22

uint table(uint at) { return texelFetch(tables, int(at)).x; }
float table_float(uint at) { return uintBitsToFloat(table(at)); }

// Windows are exp(−π y^T A y) where y^T A y < limit.
struct GaborBand {
  ImpactGrid grid;
  uvec2 kernel_key;
  uint entries;
  uint draws;    // places in the table: threshold and alias of each entry, …
  uint kernels;  // … frequency in 2^−31 cycle a pixel and the channels of the color of each
  vec3 spread;   // A^−1: xx, xy, yy, pixel²
  float area;    // its determinant
  float limit;
  float lowest;  // least |f|²
};

GaborBand band_at(uint number) {
  uint at = number * uint(BAND_WORDS);
  GaborBand band;
  band.grid.first_cell = uvec4(table(at), table(at + 1u), table(at + 2u), table(at + 3u));
  band.grid.corner = ivec2(table(at + 4u), table(at + 5u));
  band.grid.key = uvec2(table(at + 6u), table(at + 7u));
  band.grid.side = int(table(at + 8u));
  band.grid.thresholds = ivec2(table(at + 9u), table(at + 10u));
  band.kernel_key = uvec2(table(at + 11u), table(at + 12u));
  band.entries = table(at + 13u);
  band.draws = table(at + 14u);
  band.kernels = table(at + 15u);
  band.spread = vec3(table_float(at + 16u), table_float(at + 17u), table_float(at + 18u));
  band.area = table_float(at + 19u);
  band.limit = table_float(at + 20u);
  band.lowest = table_float(at + 21u);
  return band;
}

// A coordinate from the base in 64 bits, in 2^−22 pixel.
uvec2 wide_coordinate(int coarse, int fine) { return uvec2(uint(coarse) << 12 | uint(fine), uint(coarse >> 20)); }

// The random words of an impact: those that draw the entry, the phase and the weight.
uvec4 kernel_words(GaborBand band, PlanePoint place) {
  uvec2 x = add_wide(base_place.xy, wide_coordinate(place.coarse.x, place.fine.x));
  uvec2 y = add_wide(base_place.zw, wide_coordinate(place.coarse.y, place.fine.y));
  return philox_block(band.kernel_key, uvec4(x, y));
}

uint drawn_entry(GaborBand band, uint word) {
  uint entry, rest;
  umulExtended(word, band.entries, entry, rest);
  uint at = band.draws + 2u * entry;
  return rest < table(at) ? entry : table(at + 1u);
}

// (2 word + 1) 2^−32 − 1, rounded once.
float uniform_weight(uint word) {
  int wide = int(word ^ 0x80000000u);
  uint magnitude = uint(wide < 0 ? ~wide : wide);
  precise float rounded = float(magnitude >> 8) * 256.0 + (float(magnitude & 255u) + 0.5);
  return (wide < 0 ? -rounded : rounded) * (1.0 / 2147483648.0);
}

// What is drawn for an impact.
struct GaborKernel {
  uint entry;
  uint phase;  // in 2^−32 turn
  float weight;
};

GaborKernel kernel_of(GaborBand band, PlaneImpact impact) {
  uvec4 words = kernel_words(band, impact.place);
#ifdef FIXED_PHASE
  words.y = FIXED_PHASE;
#endif
#if UNIFORM_WEIGHT
  impact.weight *= uniform_weight(words.z);
#endif
  return GaborKernel(drawn_entry(band, words.x), words.y, impact.weight);
}
