// A work group of 16 x 16 pixels, whose threads call texture_at() together, for the samples of a pass.
#define COMPUTE
#include "plane.glsl"
#include "space.glsl"
#ifdef SURFACE
#include "surface_frame.glsl"
#else
#include "frame.glsl"
#endif

layout(local_size_x = 16, local_size_y = 16) in;
#include RECIPE
#include "sample.glsl"

layout(rgba32f, binding = 0) uniform image2D channels_0;
#if CHANNELS > 4
layout(rgba32f, binding = 1) uniform image2D channels_1;
#endif

shared ivec2 tile_low;
shared ivec2 tile_high;

// All points of the group that are covered; low above high when there is none.
PlaneBox box_of_group(View view, ivec2 sample_index) {
  if (is_raster()) {
    ivec2 first = ivec2(gl_WorkGroupID.xy * gl_WorkGroupSize.xy);
    ivec2 last = min(first + ivec2(gl_WorkGroupSize.xy), frame_size) - 1;
    return PlaneBox(view_of(first, sample_index).point.coarse, view_of(last, sample_index).point.coarse);
  }
  barrier();  // all have read the last box
  if (gl_LocalInvocationIndex == 0u) {
    tile_low = ivec2(0x7fffffff);
    tile_high = ivec2(-0x7fffffff);
  }
  barrier();
  if (view.covered) {
    atomicMin(tile_low.x, view.point.coarse.x);
    atomicMin(tile_low.y, view.point.coarse.y);
    atomicMax(tile_high.x, view.point.coarse.x);
    atomicMax(tile_high.y, view.point.coarse.y);
  }
  barrier();
  return PlaneBox(tile_low, tile_high);
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  bool is_inside = all(lessThan(pixel, frame_size));
  pixel = min(pixel, frame_size - 1);
  float sums[8] = float[8](0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
  for (int i = 0; i < samples_a_pass(); ++i) {
    View view = view_of(pixel, ivec2(i, sample_row));
    PlaneBox box = box_of_group(view, ivec2(i, sample_row));
    if (any(greaterThan(box.low, box.high))) {  // no pixel of the group shows the texture
      for (int c = 0; c < CHANNELS; ++c) sums[c] += background;
      continue;
    }
    if (!view.covered) {
      view.point = PlanePoint(box.low, ivec2(0));
      view.footprint = mat2(0.0);
    }
    float values[CHANNELS];
    sample_at(view, box, values);
    for (int c = 0; c < CHANNELS; ++c) sums[c] += view.covered ? values[c] : background;
  }
  float share = 1.0 / float(supersampling * supersampling);
  if (is_inside) {
    vec4 values = share * vec4(sums[0], sums[1], sums[2], sums[3]);
    if (sample_row > 0) values += imageLoad(channels_0, pixel);
    imageStore(channels_0, pixel, values);
#if CHANNELS > 4
    values = share * vec4(sums[4], sums[5], sums[6], sums[7]);
    if (sample_row > 0) values += imageLoad(channels_1, pixel);
    imageStore(channels_1, pixel, values);
#endif
  }
}
