#include "methods/base/block_fft.h"

#include <algorithm>
#include <complex>
#include <cstring>
#include <map>
#include <mutex>
#include <numbers>
#include <utility>
#include <vector>

#include "methods/base/fft_plan.h"
#include "methods/base/lanes.h"

namespace textonbench {

/// What the transforms of one length share.
struct BlockFft::Tables {
  explicit Tables(int n);

  int length;
  std::vector<int> radices;                ///< of the passes; their product is the length, or they are none
  std::vector<std::complex<float>> roots;  ///< exp(−2πi k / length)
};

BlockFft::Tables::Tables(int n) : length(n) {
  int rest = n;
  for (const int radix : {4, 2, 3, 5, 7}) {
    for (; rest % radix == 0; rest /= radix) {
      radices.push_back(radix);
    }
  }
  if (rest != 1) {
    radices.clear();
    return;
  }
  roots.reserve(static_cast<std::size_t>(n));
  for (int k = 0; k < n; ++k) {
    roots.emplace_back(std::polar(1.0, -2 * std::numbers::pi * k / n));
  }
}

namespace {

const BlockFft::Tables& shared_tables(int length) {
  static std::mutex& mutex = *new std::mutex;  // neither is destroyed: threads may outlive static destruction
  static auto& tables = *new std::map<int, const BlockFft::Tables>;
  const std::lock_guard lock(mutex);
  return tables.try_emplace(length, length).first->second;
}

/// One number of each of the eight lines.
struct Numbers {
  FloatLanes re, im;
};

/// z(k) ← Σ_j z(j) ω^{jk}, ω = exp(−2πi / radix), whose powers are `roots`.
template <int radix>
[[gnu::always_inline]] inline void transform_few(Numbers (&z)[radix], const std::complex<float> (&roots)[radix]) {
  if constexpr (radix == 2) {
    const Numbers difference = {z[0].re - z[1].re, z[0].im - z[1].im};
    z[0] = {z[0].re + z[1].re, z[0].im + z[1].im};
    z[1] = difference;
  } else if constexpr (radix == 4) {
    const Numbers even = {z[0].re + z[2].re, z[0].im + z[2].im};
    const Numbers even_off = {z[0].re - z[2].re, z[0].im - z[2].im};
    const Numbers odd = {z[1].re + z[3].re, z[1].im + z[3].im};
    const Numbers odd_off = {z[1].re - z[3].re, z[1].im - z[3].im};
    z[0] = {even.re + odd.re, even.im + odd.im};
    z[1] = {even_off.re + odd_off.im, even_off.im - odd_off.re};
    z[2] = {even.re - odd.re, even.im - odd.im};
    z[3] = {even_off.re - odd_off.im, even_off.im + odd_off.re};
  } else {  // odd: ω^{jk} and ω^{−jk} are conjugate, so terms j and −j share their products
    constexpr int half = radix / 2;
    Numbers sum[half];
    Numbers off[half];
    const Numbers first = z[0];
    for (int j = 1; j <= half; ++j) {
      sum[j - 1] = {z[j].re + z[radix - j].re, z[j].im + z[radix - j].im};
      off[j - 1] = {z[j].re - z[radix - j].re, z[j].im - z[radix - j].im};
      z[0] = {z[0].re + sum[j - 1].re, z[0].im + sum[j - 1].im};
    }
    for (int k = 1; k <= half; ++k) {
      Numbers even = first;
      Numbers odd = {};
      for (int j = 1; j <= half; ++j) {
        const std::complex<float> root = roots[j * k % radix];
        even.re += root.real() * sum[j - 1].re;
        even.im += root.real() * sum[j - 1].im;
        odd.re += root.imag() * off[j - 1].re;
        odd.im += root.imag() * off[j - 1].im;
      }
      z[k] = {even.re - odd.im, even.im + odd.re};
      z[radix - k] = {even.re + odd.im, even.im - odd.re};
    }
  }
}

/// A pass of Stockham's algorithm, which makes `stride` · `radix` transforms of length n / radix out of `stride`
/// transforms of length n = length / stride. Number p of transform q is at row q + stride p. `real` is the place of
/// the real parts in a row.
template <int radix>
[[gnu::always_inline]] inline void pass(const BlockFft::Tables& tables, std::ptrdiff_t stride, int real,
                                        const float* from, float* to) {
  const std::complex<float>* all_roots = tables.roots.data();
  const std::ptrdiff_t rest = tables.length / stride / radix;
  const std::ptrdiff_t from_step = rest * stride * block_row;
  const std::ptrdiff_t to_step = stride * block_row;
  const std::ptrdiff_t imag = block_lines - std::ptrdiff_t{2} * real;  // from the real parts to the imaginary ones
  std::complex<float> roots[radix];
  for (int j = 0; j < radix; ++j) {
    roots[j] = all_roots[j * rest * stride];
  }
  for (std::ptrdiff_t p = 0; p < rest; ++p) {
    std::complex<float> twiddles[radix];
    for (int k = 1; k < radix; ++k) {
      twiddles[k] = all_roots[k * p * stride];
    }
    const float* in = from + p * to_step + real;
    float* out = to + p * to_step * radix + real;
    for (std::ptrdiff_t q = 0; q < stride; ++q, in += block_row, out += block_row) {
      Numbers z[radix];
      for (int j = 0; j < radix; ++j) {
        load(in + j * from_step, z[j].re);
        load(in + j * from_step + imag, z[j].im);
      }
      transform_few<radix>(z, roots);
      store(z[0].re, out);
      store(z[0].im, out + imag);
      for (int k = 1; k < radix; ++k) {
        store(z[k].re * twiddles[k].real() - z[k].im * twiddles[k].imag(), out + k * to_step);
        store(z[k].re * twiddles[k].imag() + z[k].im * twiddles[k].real(), out + k * to_step + imag);
      }
    }
  }
}

__attribute__((target_clones("default", "avx2"))) void run_pass(const BlockFft::Tables& tables, int radix, int stride,
                                                                int real, const float* from, float* to) {
  switch (radix) {
    case 2:
      return pass<2>(tables, stride, real, from, to);
    case 3:
      return pass<3>(tables, stride, real, from, to);
    case 4:
      return pass<4>(tables, stride, real, from, to);
    case 5:
      return pass<5>(tables, stride, real, from, to);
    default:
      return pass<7>(tables, stride, real, from, to);
  }
}

/// Swapping real and imaginary parts, before and after, turns the forward transform into the backward one.
void transform(const BlockFft::Tables& tables, int real, const float* from, float* to, float* work) {
  if (tables.radices.empty()) {
    std::memcpy(to, from, static_cast<std::size_t>(tables.length) * block_row * sizeof(float));
    const AwkwardBlockFft fft(tables.length, real == 0 ? FftDirection::forward : FftDirection::backward);
    return fft(to);
  }
  float* next = tables.radices.size() % 2 == 0 ? work : to;  // so that the last pass writes `to`
  int stride = 1;
  for (const int radix : tables.radices) {
    run_pass(tables, radix, stride, real, from, next);
    stride *= radix;
    from = next;
    next = next == to ? work : to;
  }
}

}  // namespace

BlockFft::BlockFft(int length) : tables_(&shared_tables(length)) {}

void BlockFft::forward(const float* from, float* to, float* work) const { transform(*tables_, 0, from, to, work); }

void BlockFft::backward(const float* from, float* to, float* work) const {
  transform(*tables_, block_lines, from, to, work);
}

}  // namespace textonbench
