// What the pixels of a frame show of a surface: what surface_fragment.glsl has drawn for this sample of each.

uniform ivec2 frame_size;
uniform int supersampling;  // n: n x n samples a pixel, one a pass
uniform int sample_row;     // number of the pass

uniform sampler2D surface_place;
uniform sampler2D surface_normal;
uniform sampler2D surface_coordinate;
uniform sampler2D surface_right;
uniform sampler2D surface_down;

uniform ivec2 origin_coarse;  // place of the coordinates (0, 0), as in frame.glsl
uniform uvec2 origin_fraction;

struct View {
  bool covered;
  PlanePoint point;
  mat2 footprint;
  SpacePoint place;
  mat2x3 slopes;  // a gradient by the coordinates, in space; of a texture in space, by u1 and u2
};

const float background = 1.0;

bool is_raster() { return false; }
int samples_a_pass() { return 1; }

View view_of(ivec2 pixel, ivec2 sample_index) {
  vec4 place = texelFetch(surface_place, pixel, 0);
  vec3 normal = texelFetch(surface_normal, pixel, 0).xyz;
  vec4 coordinate = texelFetch(surface_coordinate, pixel, 0);
  vec4 right = texelFetch(surface_right, pixel, 0);
  vec4 down = texelFetch(surface_down, pixel, 0);
  View view;
  view.covered = place.w > 0.0;
  view.point = moved(PlanePoint(origin_coarse, ivec2(origin_fraction >> 20)), coordinate.xy);
  view.place = space_point(place.xyz, normal);
  float side = 1.0 / float(supersampling);
#if IN_SPACE
  view.slopes = mat2x3(view.place.frame);
  view.footprint = side * mat2(right.xyz * view.slopes, down.xyz * view.slopes);
#else
  mat2 by_pixel = mat2(right.w, coordinate.z, down.w, coordinate.w);
  view.footprint = side * by_pixel;
  // Derivatives by the pixel become those in space: the dual basis of `right` and `down` on the surface.
  vec3 across = cross(right.xyz, down.xyz);
  float area = max(dot(across, across), 1e-30);
  mat2x3 dual = mat2x3(cross(down.xyz, across) / area, cross(across, right.xyz) / area);
  view.slopes = dual * transpose(by_pixel);
#endif
  return view;
}
