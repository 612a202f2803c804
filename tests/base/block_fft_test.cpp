// Held to a naive transform in double precision.
#include "methods/base/block_fft.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstring>
#include <numbers>
#include <vector>

#include "methods/base/aligned_buffer.h"
#include "methods/base/random.h"

namespace textonbench::block_fft_test {

using Block = AlignedBuffer<float>;

Block empty_block(int length) { return Block(static_cast<std::size_t>(length * block_row)); }

Block noise(int length) {
  Block block = empty_block(length);
  fill_normal(Stream(Seed{1}).child("block_fft_test"), 0, 0, {block.data(), block.size()});
  return block;
}

std::complex<double> number(const Block& block, int line, int k) {
  const float* row = block.data() + k * block_row;
  return {row[line], row[line + block_lines]};
}

/// Largest error of a transform of `from`, over the largest number of its line.
double error(const Block& from, const Block& to, int length, double sign) {
  std::vector<std::complex<double>> roots;
  roots.reserve(static_cast<std::size_t>(length));
  for (int k = 0; k < length; ++k) {
    roots.push_back(std::polar(1.0, sign * 2 * std::numbers::pi * k / length));
  }
  double worst = 0;
  for (int line = 0; line < block_lines; ++line) {
    double largest = 0;
    double off = 0;
    for (int k = 0; k < length; ++k) {
      std::complex<double> sum = 0;
      for (int x = 0; x < length; ++x) {
        sum += number(from, line, x) * roots[static_cast<std::size_t>(x) * k % length];
      }
      largest = std::max(largest, std::abs(sum));
      off = std::max(off, std::abs(sum - number(to, line, k)));
    }
    worst = std::max(worst, off / largest);
  }
  return worst;
}

void expect_naive_transforms(int length) {
  const Block from = noise(length);
  const Block again = noise(length);
  const Block to = empty_block(length);
  const Block work = empty_block(length);
  const BlockFft fft(length);
  const double tolerance = 2e-7 * std::sqrt(std::max(1.0, std::log2(length)));
  fft.forward(from.data(), to.data(), work.data());
  EXPECT_LE(error(from, to, length, -1), tolerance) << "forward, length " << length;
  fft.backward(from.data(), to.data(), work.data());
  EXPECT_LE(error(from, to, length, 1), tolerance) << "backward, length " << length;
  EXPECT_EQ(std::memcmp(from.data(), again.data(), again.bytes()), 0) << "the input changed, length " << length;
}

TEST(BlockFft, IsTheNaiveTransformOfEveryShortLength) {
  for (int length = 1; length <= 66; ++length) {
    expect_naive_transforms(length);
  }
}

TEST(BlockFft, IsTheNaiveTransformOfLongerLengths) {
  for (const int length : {105, 128, 194, 243, 343, 500, 512, 625, 768, 1021}) {
    expect_naive_transforms(length);
  }
}

}  // namespace textonbench::block_fft_test
