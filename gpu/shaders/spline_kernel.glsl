// Kernels h_k(y) = Σ_j α_k(j) β^n(y1 − j1) β^n(y2 − j2) of ORDER n, WIDTH x HEIGHT coefficients, as layers of a texture
// array of TEXELS_X x TEXELS_Y texels that hold four channels each: layer GROUPS k + g has the channels from 4 g on.
//
// FILTER of the kernels by the footprint of a pixel: 0 none, 1 nearest mip level, 2 trilinear, 3 anisotropic, as
// KernelFilter of methods/spot/texton_filter.h. MANUAL_FETCH reads single texels; with a filter, it chooses levels and
// probes here and leaves only the reading between texels and levels to the sampler.
#define GROUPS ((CHANNELS + 3) / 4)

uniform sampler2DArray texton;

const ivec2 coefficients = ivec2(WIDTH, HEIGHT);

// A point at the distance d from an impact has the ORDER + 1 taps from floor(d + tap_offset) − ORDER on along an axis
// (methods/spot/spline_place.h), some of them on the kernel where that floor is in [0, reach / plane_unit).
const int tap_offset = (ORDER - ORDER / 2) * plane_unit + (ORDER % 2 == 0 ? plane_unit / 2 : 0);
const ivec2 reach = (coefficients + ORDER) * plane_unit;

// How kernels are read under a footprint: by `probes` along its longer column `axis`, of a level of the mip chain.
struct KernelFilter {
  mat2 footprint;
  vec2 axis;
  int probes;
  float level;
  ivec2 margin;  // by how much the filtered kernel, or the part of it that is shown, is wider on each side
};

KernelFilter kernel_filter(mat2 footprint) {
#if FILTER == 0
  return KernelFilter(footprint, vec2(0.0), 1, 0.0, ivec2(0));
#else
  KernelFilter kernel = KernelFilter(footprint, footprint[0], 1, 0.0, ivec2(0));
  float longer = length(footprint[0]);
  float shorter = length(footprint[1]);
  if (longer < shorter) {
    kernel.axis = footprint[1];
    longer = shorter;
    shorter = length(footprint[0]);
  }
#if FILTER == 3
  kernel.probes = int(clamp(ceil(longer / max(shorter, 1e-20)), 1.0, 16.0));
#endif
  // The coarsest level is one texel.
  float coarsest = round(log2(float(TEXELS_X)));
  kernel.level = clamp(log2(max(longer / float(kernel.probes), 1.0)), 0.0, coarsest);
#if !WINDOW_KERNEL
  vec2 margin = vec2(1.5 * (exp2(ceil(kernel.level)) - 1.0));
  if (kernel.probes > 1) margin += 0.5 * abs(kernel.axis);
  // No farther than points are from the base, nor more cells than a work group counts.
  float limit = min(float(1 << 28), 16384.0 * float(cell_side));
  kernel.margin = ivec2(min(ceil(margin * float(plane_unit)), limit));
#endif
  return kernel;
#endif
}

// Impacts whose kernels may reach a point of the tile.
PlaneBox reaching(PlaneBox tile, ivec2 margin) {
  return PlaneBox(tile.low + tap_offset - reach - margin, tile.high + tap_offset + margin);
}

// Weights of the taps at the position t in [0, 1) between knots, by the recurrence of Cox and de Boor.
float[ORDER + 1] spline_weights(float t) {
  float weights[ORDER + 1];
  weights[0] = 1.0;
  for (int n = 1; n <= ORDER; ++n) {
    float carried = 0.0;
    for (int i = 0; i < n; ++i) {
      float share = weights[i] * (1.0 / float(n));
      weights[i] = carried + (float(i + 1) - t) * share;
      carried = (t + float(n - i - 1)) * share;
    }
    weights[n] = carried;
  }
  return weights;
}

vec4 coefficient(ivec2 at, int layer) {
  bool is_inside = all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, coefficients));
  return is_inside ? texelFetch(texton, ivec3(at, layer), 0) : vec4(0.0);
}

// Between texels, `at` in coefficients.
vec4 bilinear(vec2 at, int layer) {
  return textureLod(texton, vec3((at + 0.5) / vec2(TEXELS_X, TEXELS_Y), layer), 0.0);
}

// h, or the filtered h, at `offset` pixels from the impact: `first` is the first tap and t the position between knots.
vec4 kernel_value(vec2 offset, ivec2 first, vec2 t, KernelFilter kernel, int layer) {
#if FILTER != 0 && MANUAL_FETCH
  vec4 value = vec4(0.0);
  for (int i = 1; i <= kernel.probes; ++i) {
    float place = float(i) / float(kernel.probes + 1) - 0.5;
    vec2 probe = (offset + place * kernel.axis + 0.5) / vec2(TEXELS_X, TEXELS_Y);
    value += textureLod(texton, vec3(probe, layer), kernel.level);
  }
  return value / float(kernel.probes);
#elif FILTER != 0
  vec2 texels = vec2(TEXELS_X, TEXELS_Y);
  return textureGrad(texton, vec3((offset + 0.5) / texels, layer), kernel.footprint[0] / texels,
                     kernel.footprint[1] / texels);
#elif ORDER == 0
  return coefficient(first, layer);
#elif MANUAL_FETCH
  float[ORDER + 1] x = spline_weights(t.x);
  float[ORDER + 1] y = spline_weights(t.y);
  vec4 value = vec4(0.0);
  for (int j = 0; j <= ORDER; ++j) {
    vec4 row = vec4(0.0);
    for (int i = 0; i <= ORDER; ++i) row += x[i] * coefficient(first + ivec2(i, j), layer);
    value += y[j] * row;
  }
  return value;
#elif ORDER == 1
  return bilinear(offset, layer);
#else
  // The four taps of an axis are two pairs, and each pair one place between its texels (Sigg and Hadwiger, GPU Gems 2,
  // chapter 20).
  float[ORDER + 1] x = spline_weights(t.x);
  float[ORDER + 1] y = spline_weights(t.y);
  vec2 left = vec2(x[0] + x[1], y[0] + y[1]);
  vec2 right = vec2(x[2] + x[3], y[2] + y[3]);
  vec2 from = vec2(first) + vec2(x[1], y[1]) / left;
  vec2 to = vec2(first) + 2.0 + vec2(x[3], y[3]) / right;
  return left.y * (left.x * bilinear(from, layer) + right.x * bilinear(vec2(to.x, from.y), layer)) +
         right.y * (left.x * bilinear(vec2(from.x, to.y), layer) + right.x * bilinear(to, layer));
#endif
}

// Adds what an impact is at a point.
void add_impact(PlanePoint point, KernelFilter kernel, PlaneImpact impact, inout vec4 sums[GROUPS]) {
  ivec2 fine = point.fine - impact.place.fine;
  ivec2 from_first = point.coarse - impact.place.coarse + (fine >> 12) + tap_offset;
  if (any(lessThan(from_first, -kernel.margin)) || any(greaterThanEqual(from_first, reach + kernel.margin))) return;
  vec2 t = vec2((from_first & (plane_unit - 1)) << 12 | (fine & 4095)) * (1.0 / 4194304.0);
  ivec2 first = (from_first >> 10) - ORDER;
  vec2 offset = plane_difference(point, impact.place);
  for (int g = 0; g < GROUPS; ++g) {
    sums[g] += impact.weight * kernel_value(offset, first, t, kernel, impact.kernel * GROUPS + g);
  }
}
