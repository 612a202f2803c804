// Eight numbers at a time, in vector registers where the processor has them that wide.
//
// Functions that are compiled for several processors (target_clones) call these, so all of them are inlined.
#pragma once

namespace textonbench {

using FloatLanes [[gnu::vector_size(32), gnu::may_alias]] = float;

/// From and to addresses that are multiples of 32.
[[gnu::always_inline]] inline void load(const float* from, FloatLanes& lanes) {
  lanes = *reinterpret_cast<const FloatLanes*>(from);
}
[[gnu::always_inline]] inline void store(const FloatLanes& lanes, float* to) {
  *reinterpret_cast<FloatLanes*>(to) = lanes;
}

/// Lane j of rows[i] becomes lane i of rows[j].
[[gnu::always_inline]] inline void transpose(FloatLanes (&rows)[8]) {
  FloatLanes pairs[8];
  for (int i = 0; i < 8; i += 2) {
    pairs[i] = __builtin_shufflevector(rows[i], rows[i + 1], 0, 8, 2, 10, 4, 12, 6, 14);
    pairs[i + 1] = __builtin_shufflevector(rows[i], rows[i + 1], 1, 9, 3, 11, 5, 13, 7, 15);
  }
  FloatLanes fours[8];
  for (const int i : {0, 1, 4, 5}) {
    fours[i] = __builtin_shufflevector(pairs[i], pairs[i + 2], 0, 1, 8, 9, 4, 5, 12, 13);
    fours[i + 2] = __builtin_shufflevector(pairs[i], pairs[i + 2], 2, 3, 10, 11, 6, 7, 14, 15);
  }
  for (int i = 0; i < 4; ++i) {
    rows[i] = __builtin_shufflevector(fours[i], fours[i + 4], 0, 1, 2, 3, 8, 9, 10, 11);
    rows[i + 4] = __builtin_shufflevector(fours[i], fours[i + 4], 4, 5, 6, 7, 12, 13, 14, 15);
  }
}

}  // namespace textonbench
