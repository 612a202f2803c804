// Philox4x32-10 of a 64-bit key and a 128-bit counter, low words first: methods/base/random.h.
uvec4 philox_block(uvec2 philox_key, uvec4 counter) {
  for (int i = 0; i < 10; ++i) {
    uint high_x, low_x, high_z, low_z;
    umulExtended(0xD2511F53u, counter.x, high_x, low_x);
    umulExtended(0xCD9E8D57u, counter.z, high_z, low_z);
    counter = uvec4(high_z ^ counter.y ^ philox_key.x, low_z, high_x ^ counter.w ^ philox_key.y, low_x);
    philox_key += uvec2(0x9E3779B9u, 0xBB67AE85u);
  }
  return counter;
}

uvec2 add_wide(uvec2 a, uvec2 b) {
  uint carry;
  uint low = uaddCarry(a.x, b.x, carry);
  return uvec2(low, a.y + b.y + carry);
}

uvec2 add_signed(uvec2 wide, int a) { return add_wide(wide, uvec2(a, a >> 31)); }
