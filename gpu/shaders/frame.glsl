// What the pixels of a frame show of the plane.
uniform ivec2 frame_size;
uniform int supersampling;  // n: n x n samples a pixel
uniform int sample_row;     // those of this pass

// A raster: sample i along an axis, of all samples of the frame, is at origin + i step, whole numbers of 2^−10 pixel and
// 32 bits below.
uniform ivec2 origin_coarse;
uniform uvec2 origin_fraction;
uniform int step_coarse;
uniform uint step_fraction;
uniform float step_pixels;

// The ground under a camera that stands above the origin (methods/base/ground_view.h).
uniform bool is_ground;
uniform vec4 camera;     // height, focal length in pixels, sine and cosine of the pitch
uniform float furthest;  // longest footprint that is shown, pixels

struct View {
  bool covered;
  PlanePoint point;
  mat2 footprint;
};

const float background = 0.0;

bool is_raster() { return !is_ground; }
int samples_a_pass() { return supersampling; }

ivec2 raster_coordinate(int i, int coarse, uint fraction) {
  uint carry, product_high, product_low;
  umulExtended(uint(i), step_fraction, product_high, product_low);
  uint low = uaddCarry(product_low, fraction, carry);
  return ivec2(coarse + i * step_coarse + int(product_high + carry), int(low >> 20));
}

View raster_view(ivec2 i) {
  ivec2 x = raster_coordinate(i.x, origin_coarse.x, origin_fraction.x);
  ivec2 y = raster_coordinate(i.y, origin_coarse.y, origin_fraction.y);
  return View(true, PlanePoint(ivec2(x.x, y.x), ivec2(x.y, y.y)), mat2(step_pixels));
}

View ground_view(vec2 pixel, float side) {
  vec2 offset = pixel - 0.5 * (vec2(frame_size) - 1.0);
  float depth = camera.y * camera.z + offset.y * camera.w;
  // Samples of a pixel that is covered are at depths above 1/2.
  float seen = max(depth, 0.5);
  float scale = camera.x / seen;
  vec2 right = vec2(scale, 0.0);
  vec2 down = scale / seen * vec2(-offset.x * camera.w, camera.y);
  vec2 position = scale * vec2(offset.x, offset.y * camera.z - camera.y * camera.w);
  PlanePoint point = moved(PlanePoint(origin_coarse, ivec2(origin_fraction >> 20)), position);
  bool covered = depth >= 1.0 && length(right) <= furthest && length(down) <= furthest;
  return View(covered, point, mat2(right * side, down * side));
}

// Sample (i, j) of a pixel, which is covered as its center is.
View view_of(ivec2 pixel, ivec2 sample_index) {
  if (!is_ground) return raster_view(pixel * supersampling + sample_index);
  float side = 1.0 / float(supersampling);
  View view = ground_view(vec2(pixel) + (vec2(sample_index) + 0.5) * side - 0.5, side);
  view.covered = ground_view(vec2(pixel), 1.0).covered;
  return view;
}
