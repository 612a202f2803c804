// The colors of a sample. BUMPY: of a surface whose normals are those of a relief of the texture. DERIVATIVE: that by x
// (0) or y (1) in place of the values.
#ifndef SURFACE

void sample_at(View view, PlaneBox tile, out float values[CHANNELS]) {
#ifdef DERIVATIVE
  vec2 gradients[CHANNELS];
  gradient_at(view.point, view.footprint, tile, values, gradients);
  for (int c = 0; c < CHANNELS; ++c) values[c] = gradients[c][DERIVATIVE];
#else
  texture_at(view.point, view.footprint, tile, values);
#endif
}

#else

uniform vec4 towards;  // the direction to the viewer
uniform vec4 light;    // that to the light, which BUMPY surfaces have apart from the viewer's
uniform float bump;    // height of a unit of the relief, pixels of the texture

void sample_at(View view, PlaneBox tile, out float values[CHANNELS]) {
  vec3 normal = view.place.frame[2];
#ifdef BUMPY
  vec2 gradients[CHANNELS];
#if IN_SPACE
  gradient_in_space(view.place, view.footprint, values, gradients);
#else
  gradient_at(view.point, view.footprint, tile, values, gradients);
#endif
  int channels = CHANNELS < 3 ? CHANNELS : 3;
  vec2 gradient = vec2(0.0);
  for (int c = 0; c < channels; ++c) gradient += gradients[c] / float(channels);
  normal = normalize(normal - bump * (view.slopes * gradient));
  if (dot(view.place.frame[2], towards.xyz) < 0.0) normal = -normal;
  float facing = max(dot(normal, light.xyz), 0.0);
#else
#if IN_SPACE
  texture_in_space(view.place, view.footprint, values);
#else
  texture_at(view.point, view.footprint, tile, values);
#endif
  float facing = abs(dot(normal, towards.xyz));
#endif
  for (int c = 0; c < CHANNELS; ++c) values[c] *= 0.25 + 0.75 * facing;
}

#endif
