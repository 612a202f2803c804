// Kernels with their derivatives, of ORDER 1 or more, in float32 from single texels.
#if GRADIENTS

// Derivatives of spline_weights(): those of β^n are differences of β^(n−1).
float[ORDER + 1] spline_slopes(float t) {
  float slopes[ORDER + 1];
  // The weights of order n − 1, as in spline_weights().
  float weights[ORDER + 1];
  weights[0] = 1.0;
  for (int n = 1; n < ORDER; ++n) {
    float carried = 0.0;
    for (int i = 0; i < n; ++i) {
      float share = weights[i] * (1.0 / float(n));
      weights[i] = carried + (float(i + 1) - t) * share;
      carried = (t + float(n - i - 1)) * share;
    }
    weights[n] = carried;
  }
  weights[ORDER] = 0.0;
  slopes[0] = -weights[0];
  for (int i = 1; i <= ORDER; ++i) slopes[i] = weights[i - 1] - weights[i];
  return slopes;
}

vec4 kernel_gradient(ivec2 first, vec2 t, int layer, out vec4 along_x, out vec4 along_y) {
  float[ORDER + 1] x = spline_weights(t.x), y = spline_weights(t.y);
  float[ORDER + 1] slope_x = spline_slopes(t.x), slope_y = spline_slopes(t.y);
  vec4 value = vec4(0.0);
  along_x = along_y = vec4(0.0);
  for (int j = 0; j <= ORDER; ++j) {
    vec4 row = vec4(0.0), sloped = vec4(0.0);
    for (int i = 0; i <= ORDER; ++i) {
      vec4 texel = coefficient(first + ivec2(i, j), layer);
      row += x[i] * texel;
      sloped += slope_x[i] * texel;
    }
    value += y[j] * row;
    along_x += y[j] * sloped;
    along_y += slope_y[j] * row;
  }
  return value;
}

// As add_impact(), with derivatives.
void add_sloped_impact(PlanePoint point, PlaneImpact impact, inout vec4 sums[GROUPS], inout vec4 sums_x[GROUPS],
                       inout vec4 sums_y[GROUPS]) {
  ivec2 fine = point.fine - impact.place.fine;
  ivec2 from_first = point.coarse - impact.place.coarse + (fine >> 12) + tap_offset;
  if (any(lessThan(from_first, ivec2(0))) || any(greaterThanEqual(from_first, reach))) return;
  vec2 t = vec2((from_first & (plane_unit - 1)) << 12 | (fine & 4095)) * (1.0 / 4194304.0);
  ivec2 first = (from_first >> 10) - ORDER;
  for (int g = 0; g < GROUPS; ++g) {
    vec4 along_x, along_y;
    sums[g] += impact.weight * kernel_gradient(first, t, impact.kernel * GROUPS + g, along_x, along_y);
    sums_x[g] += impact.weight * along_x;
    sums_y[g] += impact.weight * along_y;
  }
}

#endif
