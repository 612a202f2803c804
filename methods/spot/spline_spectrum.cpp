#include "methods/spot/spline_spectrum.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <span>
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

Image spline_overlap(const Image& coefficients, int order) {
  const std::span<const double> b = bspline_autocorrelation(order);
  const int width = coefficients.width();
  const int height = coefficients.height();
  Image result(coefficients.extent(), coefficients.channels());
  parallel_for(coefficients.channels(), [&](int c) {
    std::vector<double> along_rows(static_cast<std::size_t>(coefficients.extent().area()));
    const auto at = [&](int x, int y) -> double& {
      return along_rows[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
    };
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        for (int i = std::max(0, x - order); i <= std::min(width - 1, x + order); ++i) {
          at(x, y) += b[static_cast<std::size_t>(std::abs(i - x))] * static_cast<double>(coefficients.at(c, i, y));
        }
      }
    }
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        double sum = 0;
        for (int j = std::max(0, y - order); j <= std::min(height - 1, y + order); ++j) {
          sum += b[static_cast<std::size_t>(std::abs(j - y))] * at(x, j);
        }
        result.at(c, x, y) = static_cast<float>(sum);
      }
    }
  });
  return result;
}

}  // namespace textonbench
