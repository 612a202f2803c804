// One-dimensional Fourier transforms, for fft.cpp, box_fft.cpp, block_fft.cpp and double_fft.cpp. The only file pair
// that includes FFTW.
#pragma once

#include <complex>

struct fftwf_plan_s;
struct fftw_plan_s;

namespace textonbench {

enum class FftDirection { forward, backward };

/// Sums Σ_x u(x) exp(∓2πi k x / length), minus for `forward`, of complex lines that start on 64-byte boundaries. Plans
/// are made once a length and may be shared by threads.
class LineFft {
 public:
  LineFft(int length, FftDirection direction);
  /// Transforms one line in place.
  void operator()(std::complex<float>* line) const;

 private:
  fftwf_plan_s* plan_;
};

/// The same for the lines of a block (block_fft.h), in place and of any length.
class AwkwardBlockFft {
 public:
  AwkwardBlockFft(int length, FftDirection direction);
  void operator()(float* block) const;

 private:
  fftwf_plan_s* plan_;
  FftDirection direction_;
};

/// Complex lines in double precision, on 16-byte boundaries, in place.
class DoubleLineFft {
 public:
  DoubleLineFft(int length, FftDirection direction);
  void operator()(std::complex<double>* line) const;

 private:
  fftw_plan_s* plan_;
};

/// Real lines of `length` samples and their half spectra of length / 2 + 1 bins, in double precision, on 16-byte
/// boundaries and out of place.
class RealLineFft {
 public:
  explicit RealLineFft(int length);
  void forward(double* line, std::complex<double>* bins) const;
  /// The imaginary part of self-conjugate bins is ignored. The bins are lost.
  void inverse(std::complex<double>* bins, double* line) const;

 private:
  fftw_plan_s *forward_, *inverse_;
};

/// How FFTW chooses its algorithms. By default (`estimate`) plans depend on the size alone, so the same seed gives the
/// same bits in every process. With the environment variable TEXTONBENCH_FFT_PLAN=measure plans are timed and their
/// wisdom is kept in the user's cache folder ($XDG_CACHE_HOME or ~/.cache, textonbench/fftwf-wisdom and fftw-wisdom):
/// faster for awkward sizes, but the last bits may then change when the wisdom is deleted. Provenance records which was
/// used.
const char* fft_plan_rigor();

/// Version string of the FFTW library in use.
const char* fft_library_version();

}  // namespace textonbench
