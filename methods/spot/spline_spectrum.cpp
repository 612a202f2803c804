#include "methods/spot/spline_spectrum.h"

#include <cmath>
#include <utility>

#include "methods/base/bspline.h"
#include "methods/base/convolution.h"
#include "methods/base/parallel.h"

namespace textonbench {
namespace {

std::vector<double> gains_of_axis(int order, int side, int bins) {
  std::vector<double> gains;
  gains.reserve(static_cast<std::size_t>(bins));
  for (int k = 0; k < bins; ++k) {
    gains.push_back(std::sqrt(bspline_power(order, static_cast<double>(k) / side)));
  }
  return gains;
}

}  // namespace

SplineGain::SplineGain(int order, Extent grid)
    : columns_(gains_of_axis(order, grid.width, grid.width / 2 + 1)),
      rows_(gains_of_axis(order, grid.height, grid.height)) {}

Spectrum SplineGain::apply(Spectrum coefficients) const {
  for (int c = 0; c < coefficients.channels(); ++c) {
    parallel_for(coefficients.rows(), [&](int ky) {
      const auto bins = coefficients.row(c, ky);
      for (std::size_t kx = 0; kx < bins.size(); ++kx) {
        bins[kx] *= static_cast<float>(columns_[kx] * row(ky));
      }
    });
  }
  return coefficients;
}

CrossSpectrum spline_spectrum(const SplineTexton& texton, Extent grid) {
  const SplineGain gain(texton.order, grid);
  CrossSpectrum spectrum;
  spectrum.factors.reserve(texton.coefficients.kernels.size());
  for (const Image& coefficients : texton.coefficients.kernels) {
    spectrum.factors.push_back(gain.apply(forward_fft(wrap(coefficients, grid))));
  }
  return spectrum;
}

double relative_model_error(const SplineTexton& texton, const CrossSpectrum& target) {
  return relative_model_error(spline_spectrum(texton, target.grid()), target);
}

}  // namespace textonbench
