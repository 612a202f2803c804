#include "methods/spot/texton_error.h"

#include <utility>

#include "methods/base/box_fft.h"
#include "methods/spot/spline_spectrum.h"

namespace textonbench {

CrossSpectrum texton_spectrum(const Texton& texton, Extent torus) {
  CrossSpectrum spectrum;
  spectrum.factors.reserve(texton.kernels.size());
  for (const Image& kernel : texton.kernels) {
    spectrum.factors.push_back(forward_fft_of_box(kernel, torus));
  }
  return spectrum;
}

double relative_model_error(const Texton& texton, const CrossSpectrum& target, int order) {
  CrossSpectrum spectrum = texton_spectrum(texton, target.grid());
  const SplineGain gain(order, target.grid());
  for (Spectrum& factor : spectrum.factors) {
    factor = gain.apply(std::move(factor));
  }
  return relative_model_error(spectrum, target);
}

}  // namespace textonbench
