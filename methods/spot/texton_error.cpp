#include "methods/spot/texton_error.h"

#include "methods/base/box_fft.h"

namespace textonbench {

CrossSpectrum texton_spectrum(const Texton& texton, Extent torus) {
  CrossSpectrum spectrum;
  spectrum.factors.reserve(texton.kernels.size());
  for (const Image& kernel : texton.kernels) {
    spectrum.factors.push_back(forward_fft_of_box(kernel, torus));
  }
  return spectrum;
}

double relative_model_error(const Texton& texton, const CrossSpectrum& target) {
  return relative_model_error(texton_spectrum(texton, target.grid()), target);
}

}  // namespace textonbench
