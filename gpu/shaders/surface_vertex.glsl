// The corners of a mesh in orthographic projection. DISPLACED: moved along their
// normals by the texture at their place, outwards where it is above 1/2.
#include "plane.glsl"
#include "space.glsl"
#ifdef DISPLACED
#include RECIPE
#include "relief.glsl"
#endif

layout(location = 0) in vec3 corner;         // in a ball of radius 1
layout(location = 1) in vec3 corner_normal;
layout(location = 2) in vec2 corner_coordinate;

uniform vec4 right;    // directions of the picture in space, …
uniform vec4 down;
uniform vec4 towards;  // … the last one towards the viewer
uniform vec2 middle;   // of the ball in the picture, pixels from the center of the first one
uniform vec2 picture;  // pixels
uniform float radius;  // of the ball, pixels
uniform float farthest;  // that a corner may be from its middle
uniform float pixel_step;         // of the texture, a pixel of the picture
uniform float coordinate_scale;   // pixels of the texture a coordinate
uniform float displacement;       // pixels of the texture a unit of its height
uniform ivec2 origin_coarse;      // place of the coordinates (0, 0), as in frame.glsl
uniform uvec2 origin_fraction;

out vec3 place;  // pixels of the picture
out vec3 rest;   // the place before it is displaced
out vec3 bent_normal;
out vec2 coordinate;  // pixels of the texture

void main() {
  rest = place = radius * corner;
  bent_normal = corner_normal;
  coordinate = coordinate_scale * corner_coordinate;
#ifdef DISPLACED
#if IN_SPACE
  float height = height_in_space(space_point(place * pixel_step, normalize(corner_normal)), mat2(0.0));
#else
  float height = height_at(moved(PlanePoint(origin_coarse, ivec2(origin_fraction >> 20)), coordinate), mat2(0.0));
#endif
  place += displacement / pixel_step * (height - 0.5) * normalize(corner_normal);
#endif
  vec2 pixel = vec2(dot(right.xyz, place), dot(down.xyz, place)) + middle;
  gl_Position = vec4((2.0 * pixel + 1.0) / picture - 1.0, -dot(towards.xyz, place) / farthest, 1.0);
}
