// Blocks of normal variates and unit complex numbers, written so that the compiler vectorises them for several
// instruction sets; every one of them rounds alike, so the bits are the same.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "methods/base/portable_math.h"
#include "methods/base/random.h"

// One version an instruction set, chosen when the program is loaded.
#define TEXTONBENCH_SIMD __attribute__((target_clones("default", "avx2", "avx512f")))

namespace textonbench {
namespace {

// Variates come in groups of 16 Philox blocks: word w of block b is variate 16 w + b of its group, so that a group is
// four vectors of 16.
constexpr std::ptrdiff_t lanes = 16;
constexpr std::ptrdiff_t group_size = 4 * lanes;

using Words = std::uint32_t[4][lanes];

/// Philox4x32-10 (Salmon et al. 2011) on 16 consecutive counters, the same words as Random123's.
inline __attribute__((always_inline)) void philox_group(std::uint64_t key, std::uint64_t row, std::uint64_t group,
                                                        Words& w) {
  // Each word in a 64-bit lane of its own, where the 32 x 32 -> 64 bit products are made; the masks tell the compiler
  // that the upper halves are zero. Unrolled loops would hide the vectors from it.
  std::uint64_t a[lanes];
  std::uint64_t b[lanes];
  std::uint64_t c[lanes];
  std::uint64_t d[lanes];
  for (int i = 0; i < lanes; ++i) {
    const std::uint64_t index = group * lanes + static_cast<std::uint64_t>(i);
    a[i] = index & 0xFFFFFFFFU;
    b[i] = index >> 32U;
    c[i] = row & 0xFFFFFFFFU;
    d[i] = row >> 32U;
  }
  std::uint64_t key0 = key & 0xFFFFFFFFU;
  std::uint64_t key1 = key >> 32U;
#pragma GCC unroll 1
  for (int round = 0; round < 10; ++round) {
#pragma GCC unroll 1
    for (int i = 0; i < lanes; ++i) {
      const std::uint64_t p0 = std::uint64_t{0xD2511F53U} * (a[i] & 0xFFFFFFFFU);
      const std::uint64_t p1 = std::uint64_t{0xCD9E8D57U} * (c[i] & 0xFFFFFFFFU);
      a[i] = (p1 >> 32U) ^ b[i] ^ key0;
      c[i] = (p0 >> 32U) ^ d[i] ^ key1;
      b[i] = p1 & 0xFFFFFFFFU;
      d[i] = p0 & 0xFFFFFFFFU;
    }
    key0 = (key0 + 0x9E3779B9U) & 0xFFFFFFFFU;
    key1 = (key1 + 0xBB67AE85U) & 0xFFFFFFFFU;
  }
  for (int i = 0; i < lanes; ++i) {
    w[0][i] = static_cast<std::uint32_t>(a[i]);
    w[1][i] = static_cast<std::uint32_t>(b[i]);
    w[2][i] = static_cast<std::uint32_t>(c[i]);
    w[3][i] = static_cast<std::uint32_t>(d[i]);
  }
}

TEXTONBENCH_SIMD void normal_groups(std::uint64_t key, std::uint64_t row, std::uint64_t group, int count, float* out) {
  for (int g = 0; g < count; ++g, out += group_size) {
    alignas(64) Words w;
    philox_group(key, row, group + static_cast<std::uint64_t>(g), w);
    for (int pair = 0; pair < 4; pair += 2) {
      float* first = out + pair * lanes;
      float* second = first + lanes;
      for (int i = 0; i < lanes; ++i) {
        const float u = (static_cast<float>(static_cast<std::int32_t>(w[pair][i] >> 1U)) + 0.5F) * 4.65661287e-10F;
        const float radius = std::sqrt(-2.0F * portable::log(u));
        float c = 0;
        float s = 0;
        portable::cos_sin(w[pair + 1][i], c, s);
        first[i] = radius * c;
        second[i] = radius * s;
      }
    }
  }
}

TEXTONBENCH_SIMD void phasor_groups(std::uint64_t key, std::uint64_t row, std::uint64_t group, int count, float* out) {
  for (int g = 0; g < count; ++g, out += 2 * group_size) {
    alignas(64) Words w;
    philox_group(key, row, group + static_cast<std::uint64_t>(g), w);
    for (int word = 0; word < 4; ++word) {
      for (int i = 0; i < lanes; ++i) {
        portable::cos_sin(w[word][i], out[2 * (word * lanes + i)], out[2 * (word * lanes + i) + 1]);
      }
    }
  }
}

/// As philox_group(), with a key and an index for each counter.
TEXTONBENCH_SIMD void philox_lanes(const std::uint64_t* keys, std::uint64_t row, const std::uint64_t* indices,
                                   std::array<std::uint32_t, 4>* out) {
  std::uint64_t a[lanes], b[lanes], c[lanes], d[lanes], key0[lanes], key1[lanes];
#pragma GCC unroll 1
  for (int i = 0; i < lanes; ++i) {
    a[i] = indices[i] & 0xFFFFFFFFU;
    b[i] = indices[i] >> 32U;
    c[i] = row & 0xFFFFFFFFU;
    d[i] = row >> 32U;
    key0[i] = keys[i] & 0xFFFFFFFFU;
    key1[i] = keys[i] >> 32U;
  }
#pragma GCC unroll 1
  for (int round = 0; round < 10; ++round) {
#pragma GCC unroll 1
    for (int i = 0; i < lanes; ++i) {
      const std::uint64_t p0 = std::uint64_t{0xD2511F53U} * (a[i] & 0xFFFFFFFFU);
      const std::uint64_t p1 = std::uint64_t{0xCD9E8D57U} * (c[i] & 0xFFFFFFFFU);
      a[i] = (p1 >> 32U) ^ b[i] ^ key0[i];
      c[i] = (p0 >> 32U) ^ d[i] ^ key1[i];
      b[i] = p1 & 0xFFFFFFFFU;
      d[i] = p0 & 0xFFFFFFFFU;
      key0[i] = (key0[i] + 0x9E3779B9U) & 0xFFFFFFFFU;
      key1[i] = (key1[i] + 0xBB67AE85U) & 0xFFFFFFFFU;
    }
  }
  for (int i = 0; i < lanes; ++i) {
    out[i] = {static_cast<std::uint32_t>(a[i]), static_cast<std::uint32_t>(b[i]), static_cast<std::uint32_t>(c[i]),
              static_cast<std::uint32_t>(d[i])};
  }
}

/// Cuts [first, first + count) into whole groups, written in place, and the partial ones at the ends, copied.
template <class T, class Groups>
void fill(std::uint64_t first, std::span<T> out, const Groups& groups) {
  std::array<T, group_size> partial;
  while (!out.empty()) {
    const auto offset = static_cast<std::size_t>(first % group_size);
    std::size_t done = 0;
    if (offset == 0 && out.size() >= group_size) {
      const std::size_t whole = std::min<std::size_t>(out.size() / group_size, 1U << 20U);
      groups(first / group_size, static_cast<int>(whole), out.data());
      done = whole * group_size;
    } else {
      groups(first / group_size, 1, partial.data());
      done = std::min(out.size(), group_size - offset);
      std::copy_n(partial.begin() + static_cast<std::ptrdiff_t>(offset), done, out.begin());
    }
    out = out.subspan(done);
    first += done;
  }
}

}  // namespace

void philox_blocks(std::span<const std::uint64_t> keys, std::uint64_t row, std::span<const std::uint64_t> indices,
                   std::span<std::array<std::uint32_t, 4>> out) {
  const std::size_t whole = out.size() / lanes * lanes;
  for (std::size_t i = 0; i < whole; i += lanes) philox_lanes(&keys[i], row, &indices[i], &out[i]);
  if (whole == out.size()) return;
  std::uint64_t key[lanes] = {}, index[lanes] = {};
  std::array<std::uint32_t, 4> blocks[lanes];
  std::ranges::copy(keys.subspan(whole), key);
  std::ranges::copy(indices.subspan(whole), index);
  philox_lanes(key, row, index, blocks);
  std::copy_n(blocks, out.size() - whole, out.begin() + static_cast<std::ptrdiff_t>(whole));
}

void fill_normal(const Stream& stream, std::uint64_t row, std::uint64_t first, std::span<float> out) {
  fill(first, out,
       [&](std::uint64_t group, int count, float* to) { normal_groups(stream.key(), row, group, count, to); });
}

void fill_plane_normal(const Stream& stream, std::int64_t x, std::int64_t y, std::span<float> out) {
  // Moved by 2^63 so that a row's numbers are consecutive across x = 0.
  fill_normal(stream, static_cast<std::uint64_t>(y), static_cast<std::uint64_t>(x) + (std::uint64_t{1} << 63U), out);
}

void fill_phasor(const Stream& stream, std::uint64_t row, std::uint64_t first, std::span<std::complex<float>> out) {
  fill(first, out, [&](std::uint64_t group, int count, std::complex<float>* to) {
    phasor_groups(stream.key(), row, group, count, reinterpret_cast<float*>(to));
  });
}

}  // namespace textonbench
