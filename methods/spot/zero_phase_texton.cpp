#include "methods/spot/zero_phase_texton.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <stdexcept>

#include "methods/base/parallel.h"

namespace textonbench {
namespace {

void require_weights(const GaussianModel& model, std::span<const double> weights) {
  if (model.spectrum.factors.size() != 1 || weights.size() != static_cast<std::size_t>(model.spectrum.channels())) {
    throw std::invalid_argument(
        fmt::format("texton of a model of {} factors and {} channels with {} weights: expected "
                    "one factor and one weight a channel",
                    model.spectrum.factors.size(), model.spectrum.channels(), weights.size()));
  }
  double sum = 0;
  for (const double weight : weights) {
    sum += std::fabs(weight);
  }
  if (!(sum > 0 && std::isfinite(sum))) {
    throw std::invalid_argument(
        fmt::format("weights of the channels {}: expected finite numbers, not all zero", fmt::join(weights, ", ")));
  }
}

}  // namespace

Texton zero_phase_texton(const GaussianModel& model, std::span<const double> weights, const Support& support) {
  require_weights(model, weights);
  Spectrum spot = model.spectrum.factors.front();
  parallel_for(spot.rows(), [&](int ky) {
    for (int kx = 0; kx < spot.columns(); ++kx) {
      std::complex<double> luminance = 0;
      double bound = 0;
      for (int c = 0; c < spot.channels(); ++c) {
        const auto term = weights[static_cast<std::size_t>(c)] * std::complex<double>(spot.at(c, kx, ky));
        luminance += term;
        bound += std::norm(term);
      }
      const double squared = std::norm(luminance);
      if (squared > 1e-12 * bound) {
        const std::complex<double> phase = std::conj(luminance) / std::sqrt(squared);
        for (int c = 0; c < spot.channels(); ++c) {
          spot.at(c, kx, ky) = std::complex<float>(std::complex<double>(spot.at(c, kx, ky)) * phase);
        }
      }
    }
  });
  Texton texton{{}, support.pixels, model.mean};
  texton.kernels.push_back(
      crop_to_support(inverse_fft(spot), -(support.box.width / 2), -(support.box.height / 2), support));
  return texton;
}

}  // namespace textonbench
