// Nothing but fetches of LAYERS layers of TEXELS_X x TEXELS_Y texels, FETCHES a pixel, and their mean: the most that a
// method with as many fetches can reach.
#include "plane.glsl"

uniform sampler2DArray SAMPLER;

vec4 texel(vec2 place, int layer, mat2 footprint) {
#if FILTERED
  vec2 texels = vec2(TEXELS_X, TEXELS_Y);
  return textureGrad(SAMPLER, vec3(place, layer), footprint[0] / texels, footprint[1] / texels);
#else
  return textureLod(SAMPLER, vec3(place, layer), 0.0);
#endif
}

uint scrambled(uint x) {
  x = (x ^ x >> 16) * 0x7feb352du;
  x = (x ^ x >> 15) * 0x846ca68bu;
  return x ^ x >> 16;
}

void texture_at(PlanePoint point, mat2 footprint, PlaneBox tile, out float values[CHANNELS]) {
  vec4 sum = vec4(0.0);
#if COHERENT
  vec2 start = (vec2(point.coarse) / float(plane_unit) + 0.5) / vec2(TEXELS_X, TEXELS_Y);
#else
  uint state = scrambled(uint(point.coarse.x) + scrambled(uint(point.coarse.y)));
#endif
  for (int i = 0; i < FETCHES; ++i) {
#if COHERENT
    vec2 place = fract(start + float(i) * vec2(0.75487767, 0.56984029));  // spread evenly over the texture
#else
    state = state * 747796405u + 2891336453u;
    vec2 place = vec2(state >> 16, state & 0xffffu) * (1.0 / 65536.0);
#endif
    sum += texel(place, i % LAYERS, footprint);
  }
  for (int c = 0; c < CHANNELS; ++c) values[c] = sum[c % 4] / float(FETCHES);
}
