// One pixel a thread, each by itself: a row of its samples.
#include "frame.glsl"
#include RECIPE

layout(location = 0) out vec4 channels_0;
#if CHANNELS > 4
layout(location = 1) out vec4 channels_1;
#endif

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float sums[8] = float[8](0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
  for (int i = 0; i < supersampling; ++i) {
    View view = view_of(pixel, ivec2(i, sample_row));
    if (view.covered) {
      float values[CHANNELS];
      texture_at(view.point, view.footprint, PlaneBox(view.point.coarse, view.point.coarse), values);
      for (int c = 0; c < CHANNELS; ++c) sums[c] += values[c];
    }
  }
  float share = 1.0 / float(supersampling * supersampling);
  channels_0 = share * vec4(sums[0], sums[1], sums[2], sums[3]);
#if CHANNELS > 4
  channels_1 = share * vec4(sums[4], sums[5], sums[6], sums[7]);
#endif
}
