// Gabor noise (methods/sparse/gabor_field.h) of BANDS bands. FILTERED is 1 where kernels are filtered
// (methods/sparse/gabor_filter.h) by the Gaussian of the covariance F F^T / 12, that of a pixel of footprint F.
#include "gabor_kernels.glsl"

uniform float start[CHANNELS];

#define KERNEL_WORDS (2 + 2 * CHANNELS)

const float pi = 3.14159265358979;

// y^T A y = along (x + shear y)² + across y², of the kernels that a pixel sees.
struct GaborWindow {
  float along;
  float shear;
  float across;
  vec2 reach;  // half of the box around it, pixels
#if FILTERED
  vec3 blur;  // S, 2π times the covariance of the filter
  vec3 loss;  // M = (S^−1 + A^−1)^−1 of the unfiltered A: kernels are exp(−π f^T M f) times `height` as high
  float height;
  bool is_seen;  // where not, less than 1e-4 of the variance is left
#endif
};

GaborWindow window_of(GaborBand band, mat2 footprint) {
  GaborWindow window;
  vec3 spread = band.spread;
  float area = band.area;
#if FILTERED
  // By determinants of sums, so that those of narrow footprints keep their digits.
  vec2 x = vec2(footprint[0].x, footprint[1].x);
  vec2 y = vec2(footprint[0].y, footprint[1].y);
  window.blur = pi / 6.0 * vec3(dot(x, x), dot(x, y), dot(y, y));
  float side = pi / 6.0 * determinant(footprint);
  float blur_area = side * side;
  area += spread.x * window.blur.z + spread.z * window.blur.x - 2.0 * spread.y * window.blur.y + blur_area;
  window.loss = (band.area * window.blur + blur_area * spread) / area;
  spread += window.blur;
  window.height = sqrt(band.area / area);
  // The variance left of an entry is exp(−2π f^T M f) times that of the height, and f^T M f at least M's lesser
  // eigenvalue, its determinant divided by the greater one, times |f|².
  float difference = 0.5 * (window.loss.x - window.loss.z);
  float greater = 0.5 * (window.loss.x + window.loss.z) + length(vec2(difference, window.loss.y));
  float lesser = blur_area * window.height * window.height / max(greater, 1e-30);
  window.is_seen = window.height * exp(-2.0 * pi * lesser * band.lowest) >= 1e-4;
#endif
  window.along = spread.z / area;
  window.shear = -spread.y / spread.z;
  window.across = 1.0 / spread.z;
  window.reach = sqrt(band.limit * spread.xz);
  return window;
}

// A y, half the gradient of y^T A y.
vec2 window_slope(GaborWindow window, vec2 y) {
  float sheared = window.along * (y.x + window.shear * y.y);
  return vec2(sheared, window.shear * sheared + window.across * y.y);
}

#if GRADIENTS
vec2 slopes[CHANNELS];  // sums of derivatives by x and y
#endif

// Adds the kernel of an impact at a point.
void add_kernel(GaborBand band, GaborWindow window, PlanePoint point, PlaneImpact impact, inout float sums[CHANNELS]) {
  ivec2 fine = point.fine - impact.place.fine;
  ivec2 coarse = point.coarse - impact.place.coarse + (fine >> 12);
  ivec2 whole = (coarse + plane_unit / 2) >> 10;
  vec2 part = vec2(coarse - whole * plane_unit) * 0.0009765625 + vec2(fine & 4095) * (1.0 / 4194304.0);
  vec2 away = vec2(whole) + part;
  float sheared = away.x + window.shear * away.y;
  float form = window.along * sheared * sheared + window.across * away.y * away.y;
  if (form >= band.limit) return;
  GaborKernel kernel = kernel_of(band, impact);
  uint at = band.kernels + kernel.entry * uint(KERNEL_WORDS);
  uvec2 frequency = uvec2(table(at), table(at + 1u));
  // Whole pixels by integers, so that phases do not lose bits far from the impact.
  uvec2 turns = 2u * frequency * uvec2(whole);
  vec2 cycles = vec2(ivec2(frequency)) * (1.0 / 2147483648.0);
  float turn = float(int(turns.x + turns.y + kernel.phase)) * (1.0 / 4294967296.0) + dot(cycles, part);
#if FILTERED
  vec3 squares = vec3(cycles.x * cycles.x, 2.0 * cycles.x * cycles.y, cycles.y * cycles.y);
  form += dot(window.loss, squares);
  kernel.weight *= window.height;
  // The frequency has become f − A S f, A filtered.
  vec2 blurred = vec2(dot(window.blur.xy, cycles), dot(window.blur.yz, cycles));
  turn -= dot(window_slope(window, away), blurred);
  cycles -= window_slope(window, blurred);
#endif
  float angle = 2.0 * pi * (turn - floor(turn + 0.5));
  vec2 wave = kernel.weight * exp(-pi * form) * vec2(cos(angle), sin(angle));
  for (int c = 0; c < CHANNELS; ++c) {
    uint color = at + uint(2 + 2 * c);
    float real = table_float(color), imaginary = table_float(color + 1u);
    sums[c] += real * wave.x - imaginary * wave.y;
#if GRADIENTS
    slopes[c] -= 2.0 * pi * ((real * wave.x - imaginary * wave.y) * window_slope(window, away) +
                             (real * wave.y + imaginary * wave.x) * cycles);
#endif
  }
}

void add_band(GaborBand band, PlanePoint point, mat2 footprint, inout float sums[CHANNELS]) {
  GaborWindow window = window_of(band, footprint);
#if FILTERED
  if (!window.is_seen) return;
#endif
  // Cells are no wider than 2^28 and points no farther than 2^30 from the base.
  ivec2 reach = ivec2(min(ceil(window.reach * float(plane_unit)), 268435456.0)) + 1;
  CellRange range = cells_of(band.grid, PlaneBox(point.coarse - reach, point.coarse + reach));
  for (int y = range.low.y; y <= range.high.y; ++y) {
    for (int x = range.low.x; x <= range.high.x; ++x) {
      ivec2 cell = ivec2(x, y);
      CellWords open = open_cell(band.grid, cell);
      uint count = impact_count(band.grid, open);
      for (uint i = 0u; i < count; ++i) {
        add_kernel(band, window, point, impact_on_plane(band.grid, cell, next_impact(band.grid, open, i)), sums);
      }
    }
  }
}

void texture_at(PlanePoint point, mat2 footprint, PlaneBox tile, out float values[CHANNELS]) {
  float sums[CHANNELS];
  for (int c = 0; c < CHANNELS; ++c) sums[c] = 0.0;
  for (uint b = 0u; b < uint(BANDS); ++b) add_band(band_at(b), point, footprint, sums);
  for (int c = 0; c < CHANNELS; ++c) values[c] = start[c] + sums[c];
}

#if GRADIENTS
void gradient_at(PlanePoint point, mat2 footprint, PlaneBox tile, out float values[CHANNELS],
                 out vec2 gradients[CHANNELS]) {
  for (int c = 0; c < CHANNELS; ++c) slopes[c] = vec2(0.0);
  texture_at(point, footprint, tile, values);
  gradients = slopes;
}
#endif
