// Complex Fourier transforms of eight lines at once, one in each lane of a vector, for box_fft.cpp.
#pragma once

#include <cstddef>

namespace textonbench {

/// A block holds eight lines of `length` complex numbers: the real parts of number k of line i are at 16 k + i, the
/// imaginary parts at 16 k + 8 + i. Blocks start on 64-byte boundaries.
constexpr int block_lines = 8;
constexpr std::ptrdiff_t block_row = std::ptrdiff_t{2} * block_lines;  ///< floats from one number of a line to the next

/// Sums Σ_x u(x) exp(∓2πi k x / length), minus for `forward`, of the lines of a block. Lengths 2^a 3^b 5^c 7^d are
/// transformed by Stockham's algorithm (each pass reads one block and writes another, and the order comes out right;
/// Van Loan, Computational Frameworks for the FFT, 1992, section 1.7), others by FFTW, which is several times
/// slower. The error is that of fft.h. Tables are made once a length and may be shared by threads.
class BlockFft {
 public:
  explicit BlockFft(int length);

  /// Transforms `from` into `to` by way of `work`: three blocks, of which the first is only read.
  void forward(const float* from, float* to, float* work) const;
  void backward(const float* from, float* to, float* work) const;

  struct Tables;

 private:
  const Tables* tables_;
};

}  // namespace textonbench
