// One-dimensional complex Fourier transforms, for fft.cpp and box_fft.cpp. The only file pair that includes FFTW.
#pragma once

#include <complex>

struct fftwf_plan_s;

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

/// The same from one line to another, which FFTW does up to three times faster; the bits differ.
class CopyingLineFft {
 public:
  CopyingLineFft(int length, FftDirection direction);
  void operator()(std::complex<float>* from, std::complex<float>* to) const;

 private:
  fftwf_plan_s* plan_;
};

/// The same for eight lines at once, in place: number k of line i is at block[8 * k + i].
class BlockFft {
 public:
  BlockFft(int length, FftDirection direction);
  void operator()(std::complex<float>* block) const;

 private:
  fftwf_plan_s* plan_;
};

/// How FFTW chooses its algorithms. By default (`estimate`) plans depend on the size alone, so the same seed gives the
/// same bits in every process. With the environment variable TEXTONBENCH_FFT_PLAN=measure plans are timed and their
/// wisdom is kept in the user's cache folder ($XDG_CACHE_HOME or ~/.cache, textonbench/fftwf-wisdom): faster for
/// awkward sizes, but the last bits may then change when the wisdom is deleted. Provenance records which was used.
const char* fft_plan_rigor();

/// Version string of the FFTW library in use.
const char* fft_library_version();

}  // namespace textonbench
