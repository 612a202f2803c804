#include "methods/spot/transport_objective.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "methods/base/box_fft.h"
#include "methods/base/parallel.h"

namespace textonbench {
namespace {

using Bin = std::complex<double>;

/// T* ĥ at one frequency.
Bin product(const Spectrum& target, const Spectrum& kernel, int kx, int ky) {
  double re = 0;
  double im = 0;
  for (int c = 0; c < target.channels(); ++c) {
    const Bin t(target.at(c, kx, ky));
    const Bin h(kernel.at(c, kx, ky));
    re += t.real() * h.real() + t.imag() * h.imag();
    im += t.real() * h.imag() - t.imag() * h.real();
  }
  return {re, im};
}

double square(const Spectrum& spectrum, int kx, int ky) {
  double sum = 0;
  for (int c = 0; c < spectrum.channels(); ++c) {
    sum += std::norm(Bin(spectrum.at(c, kx, ky)));
  }
  return sum;
}

/// Σ over the full spectrum of row_sum(ky), added in the order of the rows whatever the number of threads.
template <class RowSum>
double sum_of_rows(int rows, const RowSum& row_sum) {
  std::vector<double> sums(static_cast<std::size_t>(rows));
  parallel_for(rows, [&](int ky) { sums[static_cast<std::size_t>(ky)] = row_sum(ky); });
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

double energy_without_mean(const Spectrum& spectrum) {
  return sum_of_rows(spectrum.rows(), [&](int ky) {
    double sum = 0;
    for (int kx = ky == 0 ? 1 : 0; kx < spectrum.columns(); ++kx) {
      sum += spectrum.multiplicity(kx) * square(spectrum, kx, ky);
    }
    return sum;
  });
}

}  // namespace

TransportObjective::TransportObjective(Spectrum target, const Image& mask, int order)
    : target_(std::move(target)),
      support_(mask, target_.channels(), target_.raster()),
      gain_(order, target_.raster()),
      variance_(energy_without_mean(target_) / static_cast<double>(target_.raster().area())) {
  if (!(variance_ > 0 && std::isfinite(variance_))) {
    throw std::invalid_argument(
        fmt::format("target spectrum of variance {}: expected a texture that varies", variance_));
  }
}

std::vector<Spectrum> TransportObjective::transform(std::span<const double> kernels) const {
  const std::size_t count = kernels.size() / support_.size();
  Image image(support_.box(), target_.channels());
  std::vector<Spectrum> spectra;
  spectra.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    support_.scatter(kernels.subspan(k * support_.size(), support_.size()), image);
    spectra.push_back(gain_.apply(forward_fft_of_box(image, target_.raster())));
  }
  return spectra;
}

double TransportObjective::evaluate(std::span<const double> kernels, std::span<double> gradient) const {
  std::vector<Spectrum> spectra = transform(kernels);
  // Bin by bin: the value's terms, and ĥ_k becomes ĥ_k − T (T* ĥ_k) / s.
  const double sum = sum_of_rows(target_.rows(), [&](int ky) {
    std::vector<Bin> products(spectra.size());
    double row_sum = 0;
    for (int kx = ky == 0 ? 1 : 0; kx < target_.columns(); ++kx) {
      double energy = 0;
      double squared_overlap = 0;
      for (std::size_t k = 0; k < spectra.size(); ++k) {
        products[k] = product(target_, spectra[k], kx, ky);
        squared_overlap += std::norm(products[k]);
        energy += square(spectra[k], kx, ky);
      }
      const double s = std::sqrt(squared_overlap);
      row_sum += target_.multiplicity(kx) * (energy - 2 * s);
      if (s == 0) {
        continue;  // T is orthogonal to every kernel (or zero): the second term has no slope to offer
      }
      for (std::size_t k = 0; k < spectra.size(); ++k) {
        const Bin weight = products[k] / s;
        for (int c = 0; c < target_.channels(); ++c) {
          const Bin t(target_.at(c, kx, ky));
          const Bin part(t.real() * weight.real() - t.imag() * weight.imag(),
                         t.real() * weight.imag() + t.imag() * weight.real());
          std::complex<float>& h = spectra[k].at(c, kx, ky);
          h = std::complex<float>(Bin(h) - part);
        }
      }
    }
    return row_sum;
  });
  const double scale = 2 / (variance_ * static_cast<double>(target_.raster().area()));
  for (std::size_t k = 0; k < spectra.size(); ++k) {
    for (int c = 0; c < target_.channels(); ++c) {
      spectra[k].at(c, 0, 0) = 0;
    }
    const Image sum_over_bins = unnormalized_inverse_fft_in_box(gain_.apply(std::move(spectra[k])), support_.box(),
                                                                [](int, const BinBlock&) {});
    support_.gather(sum_over_bins, scale, gradient.subspan(k * support_.size(), support_.size()));
  }
  return 1 + sum / (variance_ * static_cast<double>(target_.raster().area()));
}

std::vector<double> TransportObjective::overlap(std::span<const double> kernels) const {
  const std::vector<Spectrum> spectra = transform(kernels);
  std::vector<double> s(static_cast<std::size_t>(target_.bins()));
  parallel_for(target_.rows(), [&](int ky) {
    for (int kx = ky == 0 ? 1 : 0; kx < target_.columns(); ++kx) {
      double squared = 0;
      for (const Spectrum& spectrum : spectra) {
        squared += std::norm(product(target_, spectrum, kx, ky));
      }
      s[static_cast<std::size_t>(ky) * static_cast<std::size_t>(target_.columns()) + static_cast<std::size_t>(kx)] =
          std::sqrt(squared);
    }
  });
  return s;
}

std::vector<Image> TransportObjective::images(std::span<const double> kernels) const {
  std::vector<Image> result;
  result.reserve(kernels.size() / support_.size());
  for (std::size_t k = 0; k < kernels.size(); k += support_.size()) {
    support_.scatter(kernels.subspan(k, support_.size()), result.emplace_back(support_.box(), support_.channels()));
  }
  return result;
}

}  // namespace textonbench
