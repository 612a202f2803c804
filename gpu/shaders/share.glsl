// The share of the second of two textures at every point, and the kernel that an impact takes by its place, bit for bit as
// methods/spot/plane_share.h does: SHARE is 1 where it is the same everywhere, 2 of a ramp along x, 3 of a picture. There
// are KERNELS − 1 borders between kernels.
#if SHARE == 1

uniform float share;
uniform int share_kernel;  // of KERNELS, the one nearest to it

float share_at(PlanePoint point) { return share; }
float share_slope_at(PlanePoint point) { return 0.0; }
int kernel_of_place(PlanePoint corner) { return share_kernel; }

#elif SHARE == 2

uniform usamplerBuffer share_borders;  // places of corners in ascending order, coarse and fine
uniform int share_anchor;              // coarse
uniform float anchor_share;            // of the ramp without its ends
uniform float share_slope;             // a pixel

float unbounded_share(PlanePoint point) {
  float pixels = float(point.coarse.x - share_anchor) * 0.0009765625 + float(point.fine.x) * (1.0 / 4194304.0);
  return anchor_share + pixels * share_slope;
}

float share_at(PlanePoint point) { return clamp(unbounded_share(point), 0.0, 1.0); }

float share_slope_at(PlanePoint point) {
  float share = unbounded_share(point);
  return share > 0.0 && share < 1.0 ? share_slope : 0.0;
}

bool is_at_border(PlanePoint corner, int border) {
  ivec2 place = ivec2(texelFetch(share_borders, 2 * border).x, texelFetch(share_borders, 2 * border + 1).x);
  return corner.coarse.x > place.x || (corner.coarse.x == place.x && corner.fine.x >= place.y);
}

#else

uniform sampler2DArray share_map;
uniform usamplerBuffer share_borders;  // bits of shares in ascending order
// Corner of the picture for the corners of kernels and for points: whole pixels, and what is left in 2^−10 pixel.
uniform ivec2 kernel_map;
uniform ivec2 kernel_map_part;
uniform ivec2 point_map;
uniform ivec2 point_map_part;

float map_share(PlanePoint point, ivec2 map, ivec2 part) {
  ivec2 size = textureSize(share_map, 0).xy;
  return texelFetch(share_map, ivec3(clamp(((point.coarse - part) >> 10) - map, ivec2(0), size - 1), 0), 0).x;
}

float share_at(PlanePoint point) { return map_share(point, point_map, point_map_part); }
float share_slope_at(PlanePoint point) { return 0.0; }

bool is_at_border(PlanePoint corner, int border) {
  uint bits = floatBitsToUint(map_share(corner, kernel_map, kernel_map_part));
  return bits >= texelFetch(share_borders, border).x;
}

#endif

#if SHARE > 1
int kernel_of_place(PlanePoint corner) {
  int low = 0;
  int high = KERNELS - 1;
  while (low < high) {
    int middle = (low + high) / 2;
    if (is_at_border(corner, middle)) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}
#endif
