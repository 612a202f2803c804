// What follows stands on the constants above alone. Coordinates are pixels of the exemplar.

// High and low word of a product of two 32-bit numbers.
uvec2 texton_noise_product(uint a, uint b) {
  uint low_low = (a & 0xFFFFu) * (b & 0xFFFFu), low_high = (a & 0xFFFFu) * (b >> 16);
  uint high_low = (a >> 16) * (b & 0xFFFFu), high_high = (a >> 16) * (b >> 16);
  uint middle = (low_low >> 16) + (low_high & 0xFFFFu) + (high_low & 0xFFFFu);
  return uvec2(high_high + (low_high >> 16) + (high_low >> 16) + (middle >> 16), a * b);
}

// Philox4x32-10 (Salmon, Moraes, Dror, Shaw, 2011).
uvec4 texton_noise_random(uvec2 key, uvec4 counter) {
  for (int i = 0; i < 10; ++i) {
    uvec2 x = texton_noise_product(0xD2511F53u, counter.x), z = texton_noise_product(0xCD9E8D57u, counter.z);
    counter = uvec4(z.x ^ counter.y ^ key.x, z.y, x.x ^ counter.w ^ key.y, x.y);
    key += uvec2(0x9E3779B9u, 0xBB67AE85u);
  }
  return counter;
}

// Block j of the random words of a cell.
uvec4 texton_noise_words(uvec2 key, ivec2 cell, uint j) {
  uvec2 high = uvec2(cell.x < 0 ? 0xFFFFFFFFu : 0u, cell.y < 0 ? 0xFFFFFFFFu : 0u);
  return texton_noise_random(uvec2(key.x ^ j, key.y), uvec4(uint(cell.x), high.x, uint(cell.y), high.y));
}

// The texture at a place in texels, between them; first row of the file at 0.
vec4 texton_noise_fetch(sampler2D texton, vec2 texel) {
  return textureLod(texton, (texel + 0.5) / vec2(TEXTON_NOISE_TEXELS), 0.0) * TEXTON_NOISE_SCALE + TEXTON_NOISE_OFFSET;
}

// Kernel k at the distance d from its impact: the first of its coefficients lies there.
vec4 texton_noise_kernel(sampler2D texton, int k, vec2 d) {
  vec2 first = vec2(TEXTON_NOISE_FRAME, TEXTON_NOISE_FRAME + k * TEXTON_NOISE_TILE);
#if TEXTON_NOISE_ORDER == 0
  return texelFetch(texton, ivec2(first + floor(d + 0.5)), 0) * TEXTON_NOISE_SCALE + TEXTON_NOISE_OFFSET;
#elif TEXTON_NOISE_ORDER == 1
  return texton_noise_fetch(texton, first + d);
#else
  // Cubic splines by four bilinear fetches: pairs of their weights are places between two texels.
  vec2 below = floor(d), t = d - below, u = 1.0 - t;
  vec2 w0 = u * u * u / 6.0, w1 = (4.0 - 6.0 * t * t + 3.0 * t * t * t) / 6.0, w3 = t * t * t / 6.0;
  vec2 left = w0 + w1, right = 1.0 - left;
  vec2 from = first + below - 1.0 + w1 / left, to = first + below + 1.0 + w3 / right;
  return left.y * (left.x * texton_noise_fetch(texton, from) +
                   right.x * texton_noise_fetch(texton, vec2(to.x, from.y))) +
         right.y * (left.x * texton_noise_fetch(texton, vec2(from.x, to.y)) +
                    right.x * texton_noise_fetch(texton, to));
#endif
}

// The noise of a key at `offset` from the corner of a cell, which may lie outside it: exact at any distance from the
// origin where the cell is near the point. Any two words are a key, and each another noise.
TEXTON_NOISE_TYPE texton_noise(sampler2D texton, uvec2 key, ivec2 cell, vec2 offset) {
  // A point is on a kernel where it is less than this away from its first coefficient, and its size from that.
  const float half_spline = 0.5 * float(TEXTON_NOISE_ORDER + 1);
  const vec2 size = vec2(TEXTON_NOISE_WIDTH - 1, TEXTON_NOISE_HEIGHT - 1) + half_spline;
  ivec2 low = ivec2(floor((offset - size) / TEXTON_NOISE_CELL)), high = ivec2(floor((offset + half_spline) / TEXTON_NOISE_CELL));
  vec4 sum = TEXTON_NOISE_START;
  for (int y = low.y; y <= high.y; ++y) {
    for (int x = low.x; x <= high.x; ++x) {
      vec2 from_corner = offset - TEXTON_NOISE_CELL * vec2(x, y);
      uvec4 words = texton_noise_words(key, cell + ivec2(x, y), 0u);
      int count = 1;
#if !TEXTON_NOISE_STRATIFIED
      count = 0;
      while (count < TEXTON_NOISE_MOST && texton_noise_thresholds[count] <= words.x) ++count;
#endif
      uint first_word = words.x;
      for (int i = 0; i < count; ++i) {
        if (i > 0 && (i & 1) != 0) words = texton_noise_words(key, cell + ivec2(x, y), uint(i + 1) / 2u);
        uvec2 place = (i & 1) != 0 ? words.xy : words.zw;
        vec2 d = from_corner - vec2(place >> 8) * (TEXTON_NOISE_CELL / 16777216.0);
        if (any(lessThan(d, vec2(-half_spline))) || any(greaterThanEqual(d, size))) continue;
        uint fraction = (place.x & 255u) << 8 | (place.y & 255u);
        int k = int((fraction * uint(TEXTON_NOISE_KERNELS)) >> 16);
#if TEXTON_NOISE_STRATIFIED
        float weight = first_word >> 31 != 0u ? -1.0 : 1.0;
#elif TEXTON_NOISE_SIGNED
        float weight = (place.y & 1u) != 0u ? -1.0 : 1.0;
#else
        float weight = 1.0;
#endif
        sum += weight * texton_noise_kernel(texton, k, d);
      }
    }
  }
  return sum.TEXTON_NOISE_CHANNELS;
}

// At a place in pixels of the exemplar. Beyond 2^18 of them float32 leaves less than 1/32 pixel: give the cell then.
TEXTON_NOISE_TYPE texton_noise(sampler2D texton, vec2 position) {
  ivec2 cell = ivec2(floor(position / TEXTON_NOISE_CELL));
  return texton_noise(texton, texton_noise_key, cell, position - TEXTON_NOISE_CELL * vec2(cell));
}
