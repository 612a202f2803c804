#include "methods/spot/barycenter.h"

#include <fmt/format.h>

#include <cmath>
#include <complex>
#include <stdexcept>

namespace textonbench {

GaussianModel barycenter(const GaussianModel& first, const GaussianModel& second, double rho) {
  const Extent a = first.spectrum.grid();
  const Extent b = second.spectrum.grid();
  const int channels = first.spectrum.channels();
  if (a != b || channels != second.spectrum.channels()) {
    throw std::invalid_argument(
        fmt::format("textures of {}x{} pixels with {} channels and {}x{} with {}: expected the same size and channels",
                    a.width, a.height, channels, b.width, b.height, second.spectrum.channels()));
  }
  if (first.spectrum.factors.size() != 1 || second.spectrum.factors.size() != 1) {
    throw std::invalid_argument(fmt::format("barycenter of models of rank {} and {}: expected rank 1",
                                            first.spectrum.factors.size(), second.spectrum.factors.size()));
  }
  if (!(rho >= 0 && rho <= 1)) {
    throw std::invalid_argument(fmt::format("weight {} of the second texture: expected 0 to 1", rho));
  }
  GaussianModel between;
  for (std::size_t c = 0; c < first.mean.size(); ++c) {
    between.mean.push_back((1 - rho) * first.mean[c] + rho * second.mean[c]);
  }
  const Spectrum& t0 = first.spectrum.factors.front();
  const Spectrum& t1 = second.spectrum.factors.front();
  Spectrum spot = Spectrum::uninitialized(a, channels);
  for (int ky = 0; ky < spot.rows(); ++ky) {
    for (int kx = 0; kx < spot.columns(); ++kx) {
      std::complex<double> product = 0;
      for (int c = 0; c < channels; ++c) {
        product += std::conj(std::complex<double>(t0.at(c, kx, ky))) * std::complex<double>(t1.at(c, kx, ky));
      }
      const double modulus = std::abs(product);
      const std::complex<double> phase = modulus > 0 ? product / modulus : 1;
      for (int c = 0; c < channels; ++c) {
        spot.at(c, kx, ky) = std::complex<float>((1 - rho) * phase * std::complex<double>(t0.at(c, kx, ky)) +
                                                 rho * std::complex<double>(t1.at(c, kx, ky)));
      }
    }
  }
  between.spectrum.factors.push_back(std::move(spot));
  return between;
}

}  // namespace textonbench
