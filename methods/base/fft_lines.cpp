#include "methods/base/fft_lines.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <optional>
#include <utility>

namespace textonbench {
namespace {

// Four bins as four 64-bit lanes, for the compiler to keep in vector registers.
using Lanes [[gnu::vector_size(32)]] = std::int64_t;

/// out[i * out_stride + j] = in[j * in_stride + i], i, j < 4.
inline __attribute__((always_inline)) void transpose_tile(const std::complex<float>* in, std::ptrdiff_t in_stride,
                                                          std::complex<float>* out, std::ptrdiff_t out_stride) {
  Lanes r[4];
  for (int j = 0; j < 4; ++j) {
    std::memcpy(&r[j], in + j * in_stride, sizeof(Lanes));
  }
  const Lanes t[4] = {__builtin_shufflevector(r[0], r[1], 0, 4, 2, 6), __builtin_shufflevector(r[0], r[1], 1, 5, 3, 7),
                      __builtin_shufflevector(r[2], r[3], 0, 4, 2, 6), __builtin_shufflevector(r[2], r[3], 1, 5, 3, 7)};
  const Lanes c[4] = {__builtin_shufflevector(t[0], t[2], 0, 1, 4, 5), __builtin_shufflevector(t[1], t[3], 0, 1, 4, 5),
                      __builtin_shufflevector(t[0], t[2], 2, 3, 6, 7), __builtin_shufflevector(t[1], t[3], 2, 3, 6, 7)};
  for (int i = 0; i < 4; ++i) {
    std::memcpy(static_cast<void*>(out + i * out_stride), &c[i], sizeof(Lanes));
  }
}

}  // namespace

__attribute__((target_clones("default", "avx2"))) void transpose(const std::complex<float>* in,
                                                                 std::ptrdiff_t in_stride, int rows, int columns,
                                                                 std::complex<float>* out, std::ptrdiff_t out_stride) {
  constexpr int ahead = 32;  // rows: far apart in memory, so no prefetcher of the processor follows them
  const int whole_rows = rows / 4 * 4;
  const int whole_columns = columns / 4 * 4;
  // Either way all of a cache line is used while it is at hand: eight bins are the shorter side.
  if (rows > columns) {
    for (int j = 0; j < whole_rows; j += 4) {
      for (int k = 0; k < 4 && j + k + ahead < rows; ++k) {
        __builtin_prefetch(in + (j + k + ahead) * in_stride);
      }
      for (int i = 0; i < whole_columns; i += 4) {
        transpose_tile(in + j * in_stride + i, in_stride, out + i * out_stride + j, out_stride);
      }
    }
  } else {
    for (int i = 0; i < whole_columns; i += 4) {
      for (int k = 0; k < 4 && i + k + ahead < columns; ++k) {
        __builtin_prefetch(out + (i + k + ahead) * out_stride, 1);
      }
      for (int j = 0; j < whole_rows; j += 4) {
        transpose_tile(in + j * in_stride + i, in_stride, out + i * out_stride + j, out_stride);
      }
    }
  }
  for (int j = 0; j < rows; ++j) {
    for (int i = j < whole_rows ? whole_columns : 0; i < columns; ++i) {
      out[i * out_stride + j] = in[j * in_stride + i];
    }
  }
}

void join_rows(const float* a, const float* b, int given, int length, std::complex<float>* z) {
  for (int x = 0; x < given; ++x) {
    z[x] = {a[x], b == nullptr ? 0.0F : b[x]};
  }
  std::fill(z + given, z + length, 0.0F);
}

void split_rows(const std::complex<float>* z, int length, float* a, float* b) {
  for (int x = 0; x < length; ++x) {
    a[x] = z[x].real();
  }
  for (int x = 0; b != nullptr && x < length; ++x) {
    b[x] = z[x].imag();
  }
}

void join_spectra(const std::complex<float>* a, const std::complex<float>* b, int length, std::complex<float>* z) {
  const std::complex<float> zero = 0;
  const std::ptrdiff_t step = b == nullptr ? 0 : 1;
  const std::complex<float>* other = b == nullptr ? &zero : b;
  z[0] = {a[0].real(), other[0].real()};
  for (int k = 1; 2 * k < length; ++k) {
    const std::complex<float> bin_a = a[k];
    const std::complex<float> bin_b = other[k * step];
    z[k] = {bin_a.real() - bin_b.imag(), bin_a.imag() + bin_b.real()};
    z[length - k] = {bin_a.real() + bin_b.imag(), bin_b.real() - bin_a.imag()};
  }
  if (length % 2 == 0) {
    z[length / 2] = {a[length / 2].real(), other[length / 2 * step].real()};
  }
}

void split_spectra(const std::complex<float>* z, int length, std::complex<float>* a, std::complex<float>* b) {
  for (int k = 0; 2 * k <= length; ++k) {
    const std::complex<float> plus = z[k];
    const std::complex<float> minus = z[k == 0 ? 0 : length - k];
    a[k] = {0.5F * (plus.real() + minus.real()), 0.5F * (plus.imag() - minus.imag())};
    if (b != nullptr) {
      b[k] = {0.5F * (plus.imag() + minus.imag()), 0.5F * (minus.real() - plus.real())};
    }
  }
}

const ColumnBlock& scratch_block(Extent raster, int channels) {
  thread_local std::optional<ColumnBlock> block;
  thread_local std::pair<int, int> shape;
  if (!block || shape != std::pair(raster.height, channels)) {
    block.emplace(raster, channels);
    shape = {raster.height, channels};
  }
  return *block;
}

std::complex<float>* scratch_row(int length) {
  thread_local std::optional<AlignedBuffer<std::complex<float>>> row;
  if (!row || row->size() < static_cast<std::size_t>(length)) {
    row.emplace(static_cast<std::size_t>(length));
  }
  return row->data();  // NOLINT(clang-analyzer-unix.Malloc): the freed row is the one that was replaced
}

}  // namespace textonbench
