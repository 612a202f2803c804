// Waves along an axis: exp(2πi k t), k whole, at a few places t.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "methods/base/aligned_buffer.h"

namespace textonbench {

/// The cosines and sines of the bins k from `least` to `most` at turns t = turns[0], turns[1], … of 2^−32, the bits of
/// portable::cos_sin. As many as `surplus` more may be read behind those of a bin: finite numbers without meaning.
class WaveTable {
 public:
  static constexpr int surplus = 16;

  WaveTable(int least, int most, std::span<const std::uint32_t> turns);
  const float* cosines(int k) const { return values_.data() + std::ptrdiff_t{k - least_} * 2 * stride_; }
  /// Where its sines are, from the cosines of a bin on.
  int sines() const { return stride_; }

 private:
  int least_;
  int stride_;
  AlignedBuffer<float> values_;
};

}  // namespace textonbench
