// Counter-based random streams (Random123's Philox4x32-10): the same bits on every x86-64 machine, for any number of
// threads, in any order of evaluation.
//
// Stream names are hashed, so a new stream never moves another one's numbers:
//
//   Stream noise = Stream(seed).child("adsn").child("noise");
//   fill_normal(noise, /*row=*/ky, /*first=*/0, out);
//
// Nothing here calls libm or a std:: distribution, whose results differ between libraries and processors.
#pragma once

#include <array>
#include <complex>
#include <cstdint>
#include <span>
#include <string_view>

namespace textonbench {

/// The user's seed: any 64-bit number.
struct Seed {
  std::uint64_t value = 0;
  friend bool operator==(const Seed&, const Seed&) = default;
};

/// Philox4x32-10 of a 64-bit key and the counter (index, row), low words first.
std::array<std::uint32_t, 4> philox_block(std::uint64_t key, std::uint64_t row, std::uint64_t index);

/// out[i] = philox_block(keys[i], row, indices[i]).
void philox_blocks(std::span<const std::uint64_t> keys, std::uint64_t row, std::span<const std::uint64_t> indices,
                   std::span<std::array<std::uint32_t, 4>> out);

/// A family of 2^64 rows of 2^66 32-bit words, addressed by (row, index).
class Stream {
 public:
  explicit Stream(Seed seed);
  Stream child(std::string_view name) const;
  Stream child(std::uint64_t index) const;
  std::uint64_t key() const { return key_; }
  /// The four words at block `index` of `row`.
  std::array<std::uint32_t, 4> block(std::uint64_t row, std::uint64_t index) const;

 private:
  explicit Stream(std::uint64_t key) : key_(key) {}
  std::uint64_t key_;
};

/// A seed derived from another one by name: for handing a part of an experiment its own numbers.
Seed derive(Seed seed, std::string_view name);
Seed derive(Seed seed, std::uint64_t index);

/// out[i] = standard normal variate number first + i of the row (Box–Muller on 32-bit uniforms: |x| <= 6.7).
/// The value depends on (stream, row, first + i) alone, not on how a row is cut into calls.
void fill_normal(const Stream& stream, std::uint64_t row, std::uint64_t first, std::span<float> out);

/// out[i] = white noise of the plane at the whole point (x + i, y), any point of Z².
void fill_plane_normal(const Stream& stream, std::int64_t x, std::int64_t y, std::span<float> out);

/// out[i] = unit complex number exp(iθ), θ uniform, number first + i of the row.
void fill_phasor(const Stream& stream, std::uint64_t row, std::uint64_t first, std::span<std::complex<float>> out);

/// Sequential reader of row 0 of a stream, for code that draws one number at a time.
class RandomSequence {
 public:
  explicit RandomSequence(const Stream& stream) : stream_(stream) {}
  std::uint32_t next();
  /// Uniform in the open interval (0, 1), 52 bits.
  double uniform();
  /// Unbiased integer in [0, bound). bound >= 1.
  std::uint64_t below(std::uint64_t bound);
  /// Standard normal in double precision.
  double normal();
  /// Exact Poisson number of any mean in [0, 1e15]: unit-rate arrivals below 10, transformed rejection (Hörmann 1993)
  /// above. Throws std::invalid_argument for a mean outside that range.
  std::int64_t poisson(double mean);

 private:
  Stream stream_;
  std::uint64_t index_ = 0;
  std::array<std::uint32_t, 4> words_{};
  int used_ = 4;
};

}  // namespace textonbench
