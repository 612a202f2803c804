// The bits of the streams: against an independent Philox4x32-10, against a scalar recomputation of the vectorized
// fills, and frozen, so that a change that would move everybody's numbers is noticed.
#include "methods/base/random.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <complex>
#include <cstdint>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "methods/base/portable_math.h"

namespace textonbench::random_test {

using Words = std::array<std::uint32_t, 4>;

/// Philox4x32-10 as printed by Salmon, Moraes, Dror and Shaw (SC11).
Words philox(Words counter, std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t p0 = std::uint64_t{0xD2511F53U} * counter[0];
    const std::uint64_t p1 = std::uint64_t{0xCD9E8D57U} * counter[2];
    counter = {static_cast<std::uint32_t>(p1 >> 32U) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(p1),
               static_cast<std::uint32_t>(p0 >> 32U) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(p0)};
    key = {key[0] + 0x9E3779B9U, key[1] + 0xBB67AE85U};
  }
  return counter;
}

std::uint32_t low(std::uint64_t v) { return static_cast<std::uint32_t>(v); }
std::uint32_t high(std::uint64_t v) { return static_cast<std::uint32_t>(v >> 32U); }

constexpr std::uint64_t largest = std::numeric_limits<std::uint64_t>::max();
constexpr std::uint64_t awkward[] = {0, 1, 0xFFFFFFFFU, 0x100000000U, 0x123456789ABCDEFU, largest};

// Known answers of Random123's kat_vectors.
TEST(PhiloxBlocks, AreThoseOfTheirKeysAndIndices) {
  std::vector<std::uint64_t> keys, indices;
  for (std::uint64_t i = 0; i < 37; ++i) {
    keys.push_back(0x123456789ABCDEFULL * (i + 1));
    indices.push_back(0xFEDCBA9876543210ULL ^ (i << 29U));
  }
  std::vector<std::array<std::uint32_t, 4>> blocks(keys.size());
  const std::uint64_t row = ~std::uint64_t{4};
  philox_blocks(keys, row, indices, blocks);
  for (std::size_t i = 0; i < blocks.size(); ++i) EXPECT_EQ(blocks[i], philox_block(keys[i], row, indices[i])) << i;
}

TEST(Philox, TheOracleOfThisTestIsRight) {
  constexpr std::uint32_t ones = 0xFFFFFFFFU;
  EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}), (Words{0x6627E8D5U, 0xE169C58DU, 0xBC57AC4CU, 0x9B00DBD8U}));
  EXPECT_EQ(philox({ones, ones, ones, ones}, {ones, ones}),
            (Words{0x408F276DU, 0x41C83B0EU, 0xA20BC7C6U, 0x6D5451FDU}));
  EXPECT_EQ(philox({0x243F6A88U, 0x85A308D3U, 0x13198A2EU, 0x03707344U}, {0xA4093822U, 0x299F31D0U}),
            (Words{0xD16CFE09U, 0x94FDCCEBU, 0x5001E420U, 0x24126EA1U}));
}

TEST(Stream, BlocksArePhilox) {
  for (const std::uint64_t seed : awkward) {
    const Stream stream = Stream(Seed{seed}).child("noise");
    for (const std::uint64_t row : awkward) {
      for (const std::uint64_t index : awkward) {
        EXPECT_EQ(stream.block(row, index),
                  philox({low(index), high(index), low(row), high(row)}, {low(stream.key()), high(stream.key())}));
      }
    }
  }
}

TEST(Stream, ChildrenNeverShareAKey) {
  std::set<std::uint64_t> keys;
  const Stream parent(Seed{1});
  keys.insert(parent.key());
  for (std::uint64_t i = 0; i < 100'000; ++i) {
    keys.insert(parent.child(i).key());
    keys.insert(parent.child(std::to_string(i)).key());
    keys.insert(Stream(Seed{i + 2}).key());
  }
  EXPECT_EQ(keys.size(), 300'001U);
}

TEST(Stream, NamesAreAPath) {
  const Stream parent(Seed{7});
  EXPECT_EQ(parent.child("adsn").child("noise").key(), Stream(Seed{7}).child("adsn").child("noise").key());
  EXPECT_NE(parent.child("adsn").child("noise").key(), parent.child("noise").child("adsn").key());
  EXPECT_NE(parent.child("adsn").child("noise").key(), parent.child("adsnnoise").key());
  EXPECT_NE(parent.child("").key(), parent.key());
}

TEST(Derive, SeedsDifferByNameIndexAndParent) {
  std::set<std::uint64_t> seeds;
  for (std::uint64_t parent = 0; parent < 100; ++parent) {
    for (std::uint64_t i = 0; i < 100; ++i) {
      seeds.insert(derive(Seed{parent}, i).value);
      seeds.insert(derive(Seed{parent}, std::to_string(i)).value);
    }
  }
  EXPECT_EQ(seeds.size(), 20'000U);
  EXPECT_EQ(derive(Seed{3}, "sample"), derive(Seed{3}, "sample"));
}

// Variate i lies in group i / 64 of 16 blocks; there it takes word i % 64 / 16 of block i % 16.
struct Place {
  std::uint64_t block;
  std::size_t word;
};
Place place_of(std::uint64_t i) { return {i / 64 * 16 + i % 16, static_cast<std::size_t>(i % 64 / 16)}; }

float scalar_normal(const Stream& stream, std::uint64_t row, std::uint64_t i) {
  const auto [block, word] = place_of(i);
  const Words words = stream.block(row, block);
  const std::size_t pair = word / 2 * 2;  // Box-Muller makes two variates of two words
  const float u = (static_cast<float>(words[pair] >> 1U) + 0.5F) * 0x1p-31F;
  const float radius = std::sqrt(-2.0F * portable::log(u));
  float cosine = 0;
  float sine = 0;
  portable::cos_sin(words[pair + 1], cosine, sine);
  return radius * (word == pair ? cosine : sine);
}

std::complex<float> scalar_phasor(const Stream& stream, std::uint64_t row, std::uint64_t i) {
  const auto [block, word] = place_of(i);
  float cosine = 0;
  float sine = 0;
  portable::cos_sin(stream.block(row, block)[word], cosine, sine);
  return {cosine, sine};
}

std::vector<float> normals(const Stream& stream, std::uint64_t row, std::uint64_t first, std::size_t count) {
  std::vector<float> out(count);
  fill_normal(stream, row, first, out);
  return out;
}

std::vector<std::complex<float>> phasors(const Stream& stream, std::uint64_t row, std::uint64_t first,
                                         std::size_t count) {
  std::vector<std::complex<float>> out(count);
  fill_phasor(stream, row, first, out);
  return out;
}

// The fills choose among several instruction sets when the program is loaded; each must round as scalar code does.
TEST(Fill, TheVectorizedBitsAreTheScalarOnes) {
  const Stream stream = Stream(Seed{2024}).child("fill");
  for (const std::uint64_t row : {std::uint64_t{0}, std::uint64_t{77}, largest}) {
    for (const std::uint64_t first : {std::uint64_t{0}, std::uint64_t{5}, (std::uint64_t{1} << 36U) - 100}) {
      const auto normal = normals(stream, row, first, 5000);
      const auto phasor = phasors(stream, row, first, 5000);
      for (std::size_t i = 0; i < normal.size(); ++i) {
        ASSERT_EQ(std::bit_cast<std::uint32_t>(normal[i]),
                  std::bit_cast<std::uint32_t>(scalar_normal(stream, row, first + i)))
            << "row " << row << ", variate " << first + i;
        ASSERT_EQ(phasor[i], scalar_phasor(stream, row, first + i)) << "row " << row << ", variate " << first + i;
      }
    }
  }
}

TEST(Fill, DoesNotDependOnHowARowIsCut) {
  const Stream stream = Stream(Seed{5}).child("cut");
  constexpr std::size_t count = 1000;
  const auto normal = normals(stream, 3, 0, count);
  const auto phasor = phasors(stream, 3, 0, count);
  for (const std::size_t size : {1, 3, 63, 64, 65, 127, 128, 200}) {
    for (const std::size_t start : {0, 1, 17, 63, 64, 100}) {
      for (std::size_t first = start; first < count; first += size) {
        const std::size_t length = std::min(size, count - first);
        const auto part = normals(stream, 3, first, length);
        const auto turned = phasors(stream, 3, first, length);
        for (std::size_t i = 0; i < length; ++i) {
          ASSERT_EQ(part[i], normal[first + i]) << "from " << first << " in pieces of " << size;
          ASSERT_EQ(turned[i], phasor[first + i]) << "from " << first << " in pieces of " << size;
        }
      }
    }
  }
  EXPECT_NO_THROW(fill_normal(stream, 0, 17, {}));
}

TEST(Fill, RowsAndStreamsHaveTheirOwnNumbers) {
  const Stream stream = Stream(Seed{5}).child("rows");
  const auto row = normals(stream, 0, 0, 64);
  EXPECT_NE(row, normals(stream, 1, 0, 64));
  EXPECT_NE(row, normals(stream, std::uint64_t{1} << 32U, 0, 64));
  EXPECT_NE(row, normals(stream, 0, 64, 64));
  EXPECT_NE(row, normals(Stream(Seed{6}).child("rows"), 0, 0, 64));
  EXPECT_NE(row, normals(stream.child("rows"), 0, 0, 64));
}

TEST(RandomSequence, ReadsTheBlocksInOrder) {
  const Stream stream = Stream(Seed{11}).child("sequence");
  RandomSequence words(stream);
  RandomSequence uniforms(stream);
  for (std::uint64_t index = 0; index < 100; ++index) {
    const Words block = stream.block(0, index);
    for (const std::uint32_t word : block) {
      EXPECT_EQ(words.next(), word);
    }
    for (const std::size_t word : {0, 2}) {
      const std::uint64_t bits = std::uint64_t{block[word]} << 32U | block[word + 1];
      EXPECT_EQ(uniforms.uniform(), (static_cast<double>(bits >> 12U) + 0.5) / 0x1p52);
    }
  }
}

// If this fails, every published number of this project changes with the same seed: do not renew it lightly.
TEST(Random, BitsAreFrozen) {
  EXPECT_EQ(derive(Seed{42}, "frozen").value, 0x03039DBFF97FB471U);
  EXPECT_EQ(derive(Seed{42}, 9).value, 0x0D4CF8C0C26B54C0U);
  const Stream stream = Stream(Seed{42}).child("frozen").child(9);
  EXPECT_EQ(stream.key(), 0x40220CA8740916A8U);

  std::vector<std::uint32_t> bits;
  for (const float v : normals(stream, 1, 2, 20)) {
    bits.push_back(std::bit_cast<std::uint32_t>(v));
  }
  EXPECT_THAT(bits, testing::ElementsAre(0xBFD91E64U, 0xBC4E5E26U, 0xBF3E6C85U, 0x3E9217A7U, 0xBFE792F9U, 0xBF492A40U,
                                         0xBFADF1CAU, 0xBF42117EU, 0xBE9305FCU, 0x3EE7E584U, 0x3F54251DU, 0xBEEE5D8CU,
                                         0x3FD4B3F7U, 0xBF943FE7U, 0x3F259DC3U, 0xBFA13608U, 0xBDB84640U, 0xBFA34BC1U,
                                         0x3F3AB77EU, 0x3EAB6291U));
  EXPECT_THAT(phasors(stream, 1, 2, 3), testing::ElementsAre(std::complex(0x1.6034eep-4F, 0x1.fe1a88p-1F),
                                                             std::complex(-0x1.dfaea4p-1F, 0x1.660b6cp-2F),
                                                             std::complex(-0x1.bec648p-1F, -0x1.f42568p-2F)));

  RandomSequence random(stream);
  EXPECT_EQ(random.uniform(), 0x1.a58f517ee9192p-2);
  EXPECT_EQ(random.normal(), -0x1.6e0da612b2339p-1);
  EXPECT_EQ(random.normal(), -0x1.f5b743d3941dbp-1);
  EXPECT_EQ(random.below(1'000'000'007), 585'097'670U);
  EXPECT_EQ(random.poisson(0.5), 1);
  EXPECT_EQ(random.poisson(9), 4);
  EXPECT_EQ(random.poisson(10), 12);
  EXPECT_EQ(random.poisson(1e3), 1024);
  EXPECT_EQ(random.poisson(1e9), 999'965'603);
  EXPECT_EQ(random.poisson(1e15), 999'999'997'738'655);
}

}  // namespace textonbench::random_test
