// Points of the plane relative to a recipe's base, in 2^−22 pixel: `coarse` in 2^−10 pixel and `fine`, the 12 bits
// below. So distances are exact up to 2^20 pixels from the base.
struct PlanePoint {
  ivec2 coarse;
  ivec2 fine;
};

// All points with coarse coordinates in [low, high].
struct PlaneBox {
  ivec2 low;
  ivec2 high;
};

const int plane_unit = 1024;  // of coarse coordinates, a pixel

// In pixels; exact to float32's rounding of the difference.
vec2 plane_difference(PlanePoint a, PlanePoint b) {
  return vec2(a.coarse - b.coarse) * 0.0009765625 + vec2(a.fine - b.fine) * (1.0 / 4194304.0);
}

// The point so many pixels from another one, fewer than 2^21.
PlanePoint moved(PlanePoint from, vec2 pixels) {
  vec2 units = pixels * 1024.0;
  vec2 whole = floor(units);
  // The fractions of both carry into the whole.
  ivec2 fine = from.fine + ivec2((units - whole) * 4096.0);
  return PlanePoint(from.coarse + ivec2(whole) + (fine >> 12), fine & 4095);
}

int floor_division(int a, int b) {
  int quotient = a / b;
  return quotient - int(a - quotient * b < 0);
}
