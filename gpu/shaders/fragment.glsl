// One pixel a thread, each by itself: the samples of a pass.
#include "plane.glsl"
#include "space.glsl"
#ifdef SURFACE
#include "surface_frame.glsl"
#else
#include "frame.glsl"
#endif
#include RECIPE
#include "sample.glsl"

layout(location = 0) out vec4 channels_0;
#if CHANNELS > 4
layout(location = 1) out vec4 channels_1;
#endif

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float sums[8] = float[8](0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
  for (int i = 0; i < samples_a_pass(); ++i) {
    View view = view_of(pixel, ivec2(i, sample_row));
    float values[CHANNELS];
    for (int c = 0; c < CHANNELS; ++c) values[c] = background;
    if (view.covered) sample_at(view, PlaneBox(view.point.coarse, view.point.coarse), values);
    for (int c = 0; c < CHANNELS; ++c) sums[c] += values[c];
  }
  float share = 1.0 / float(supersampling * supersampling);
  channels_0 = share * vec4(sums[0], sums[1], sums[2], sums[3]);
#if CHANNELS > 4
  channels_1 = share * vec4(sums[4], sums[5], sums[6], sums[7]);
#endif
}
