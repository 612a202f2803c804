// Local random-phase noise (methods/sparse/wave_field.h): waves whose bins, colors and phases are the processor's bit for
// bit. LAYERS is the number of layers, TERMS that of the window's coefficients, EVEN 1 where sums are divided by the root
// of the squared windows' sum. STRUCTURE is 1 where phases are fixed (methods/sparse/fixed_phases.h), and TURBULENT the
// number of layers of each axis of turbulence, which follow those of the noise: their channel 0 counts. GRADIENTS is 1
// where derivatives by x and y are summed into `slopes` beside the values.
#include "plane.glsl"
#include "philox.glsl"

uniform float start[CHANNELS];
uniform float window_terms[TERMS];  // p_m of w = t^(3/2) Σ p_m t^m, t = 1 − |d|² / 2.25
uniform int turn_shift;             // from 2^−22 pixel to 2^−32 turn of a bin
uniform usamplerBuffer tables;      // LAYER_WORDS a layer, then what they point to

#define LAYER_WORDS 16

const float pi = 3.14159265358979;

#if GRADIENTS
vec2 slopes[CHANNELS];
#endif

uint table(uint at) { return texelFetch(tables, int(at)).x; }
float table_float(uint at) { return uintBitsToFloat(table(at)); }

struct WaveLayer {
  uvec2 key;
  uvec4 base_cell;  // 64-bit coordinates of the cell nearest to the base: x low, x high, y low, y high
  PlanePoint center;
  ivec2 spacing;  // in 2^−10 pixel, and the 12 bits below
  uint waves;
  uint colors;
  uint first;  // places in the table: bins of each wave from, …
  uint bins;   // … for each bin kx and ky in 16 bits, colors − 1 thresholds and the channels of its colors
};

WaveLayer layer_at(uint number) {
  uint at = number * uint(LAYER_WORDS);
  WaveLayer layer;
  layer.key = uvec2(table(at), table(at + 1u));
  layer.base_cell = uvec4(table(at + 2u), table(at + 3u), table(at + 4u), table(at + 5u));
  layer.center = PlanePoint(ivec2(table(at + 6u), table(at + 7u)), ivec2(table(at + 8u), table(at + 9u)));
  layer.spacing = ivec2(table(at + 10u), table(at + 11u));
  layer.waves = table(at + 12u);
  layer.colors = table(at + 13u);
  layer.first = table(at + 14u);
  layer.bins = table(at + 15u);
  return layer;
}

// cos and sin of so many 2^−32 turns.
vec2 unit_wave(uint turns) {
  float angle = float(int(turns)) * 1.4629180792671596e-9;
  return vec2(cos(angle), sin(angle));
}

// Adds weight Re(c wave) of the channels' factors c in the table. `slope` is the weight's gradient, and `angular` the
// angle of the wave's.
void add_term(uint at, vec2 wave, float weight, vec2 slope, vec2 angular, inout float sums[CHANNELS]) {
  for (int c = 0; c < CHANNELS; ++c) {
    float real = table_float(at + uint(2 * c)), imaginary = table_float(at + uint(2 * c + 1));
    float term = real * wave.x - imaginary * wave.y;
    sums[c] += weight * term;
#if GRADIENTS
    slopes[c] += slope * term - weight * (real * wave.y + imaginary * wave.x) * angular;
#endif
  }
}

// Adds the waves of a cell, of the words (u, v) each: v is the phase, u the bin and the color. `slope` is the window's.
void add_wave(WaveLayer layer, uint j, uint u, uint v, uvec2 turns, float window, vec2 slope,
              inout float sums[CHANNELS]) {
  uint from = table(layer.first + j);
  uint high, rest;
  umulExtended(u, table(layer.first + j + 1u) - from, high, rest);
  uint at = layer.bins + (from + high) * layer.colors * uint(1 + 2 * CHANNELS);
  uint bin = table(at);
  uint color = 0u;
  for (uint c = 1u; c < layer.colors; ++c) color += uint(rest >= table(at + c));
  int kx = bitfieldExtract(int(bin), 0, 16), ky = bitfieldExtract(int(bin), 16, 16);
  vec2 wave = unit_wave(uint(kx) * turns.x + uint(ky) * turns.y + v);
  vec2 angular = 2.0 * pi * exp2(float(turn_shift - 10)) * vec2(kx, ky);
  at += layer.colors + color * uint(2 * CHANNELS);
  add_term(at, wave, window, slope, angular, sums);
}

// The window and its derivative by t.
vec2 window_at(float t) {
  float polynomial = 0.0, derivative = 0.0;
  for (int m = TERMS - 1; m >= 0; --m) {
    derivative = derivative * t + polynomial;
    polynomial = polynomial * t + window_terms[m];
  }
  float root = sqrt(t);
  return vec2(t * root * polynomial, root * (1.5 * polynomial + t * derivative));
}

void add_layer(WaveLayer layer, PlanePoint point, inout float values[CHANNELS]) {
  float sums[CHANNELS];
  for (int c = 0; c < CHANNELS; ++c) sums[c] = 0.0;
  float squares = 0.0;
#if GRADIENTS
  vec2 kept[CHANNELS] = slopes;
  for (int c = 0; c < CHANNELS; ++c) slopes[c] = vec2(0.0);
  vec2 squares_slope = vec2(0.0);
#endif
  float spacing = float(layer.spacing.x) * 0.0009765625 + float(layer.spacing.y) * (1.0 / 4194304.0);
  // Windows of the third cells away are zero to rounding, so that a cell taken for the nearest where two are does no harm.
  ivec2 nearest = ivec2(floor(plane_difference(point, layer.center) / spacing + 0.5));
  for (int i = 0; i < 9; ++i) {
    ivec2 cell = nearest + ivec2(i % 3 - 1, i / 3 - 1);
    ivec2 fine = point.fine - layer.center.fine - cell * layer.spacing.y;
    ivec2 coarse = point.coarse - layer.center.coarse - cell * layer.spacing.x + (fine >> 12);
    fine &= 4095;
    vec2 away = (vec2(coarse) * 0.0009765625 + vec2(fine) * (1.0 / 4194304.0)) / spacing;
    float t = 1.0 - dot(away, away) / 2.25;
    if (t <= 0.0) continue;
    vec2 windowed = window_at(t);
    float window = windowed.x;
    vec2 slope = windowed.y * (-2.0 / (2.25 * spacing)) * away;
    squares += window * window;
#if GRADIENTS
    squares_slope += 2.0 * window * slope;
#endif
    uvec2 turns = (uvec2(coarse) * 4096u + uvec2(fine)) << uint(turn_shift);
    uvec4 counter = uvec4(add_signed(layer.base_cell.xy, cell.x), add_signed(layer.base_cell.zw, cell.y));
    for (uint j = 0u; j < layer.waves; j += 2u) {
      uvec4 words = philox_block(uvec2(layer.key.x ^ (j >> 1u), layer.key.y), counter);
      add_wave(layer, j, words.x, words.y, turns, window, slope, sums);
      if (j + 1u < layer.waves) add_wave(layer, j + 1u, words.z, words.w, turns, window, slope, sums);
    }
  }
#if EVEN
  float scale = inversesqrt(squares);
#else
  float scale = 1.0;
#endif
  for (int c = 0; c < CHANNELS; ++c) values[c] += scale * sums[c];
#if GRADIENTS
  for (int c = 0; c < CHANNELS; ++c) {
    vec2 slope = scale * slopes[c];
#if EVEN
    slope -= 0.5 * scale * scale * scale * sums[c] * squares_slope;
#endif
    slopes[c] = kept[c] + slope;
  }
#endif
}

#if STRUCTURE
#include "fixed_phases.glsl"
#endif

void texture_at(PlanePoint point, mat2 footprint, PlaneBox tile, out float values[CHANNELS]) {
  for (int c = 0; c < CHANNELS; ++c) values[c] = start[c];
  for (uint l = 0u; l < uint(LAYERS); ++l) add_layer(layer_at(l), point, values);
#if STRUCTURE
  add_structure(point, values);
#endif
}

#if GRADIENTS
void gradient_at(PlanePoint point, mat2 footprint, PlaneBox tile, out float values[CHANNELS],
                 out vec2 gradients[CHANNELS]) {
  for (int c = 0; c < CHANNELS; ++c) slopes[c] = vec2(0.0);
  texture_at(point, footprint, tile, values);
  gradients = slopes;
}
#endif
