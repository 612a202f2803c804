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

/// Real and imaginary parts of T* α̂ along a row of bins, and |α̂|² added to `energy`.
struct RowProducts {
  std::vector<double> re, im;

  RowProducts(const Spectrum& target, const Spectrum& coefficients, int ky, std::vector<double>& energy)
      : re(energy.size()), im(energy.size()) {
    for (int c = 0; c < target.channels(); ++c) {
      const auto t = target.row(c, ky);
      const auto h = coefficients.row(c, ky);
      for (std::size_t kx = 0; kx < energy.size(); ++kx) {
        const Bin a(t[kx]);
        const Bin b(h[kx]);
        re[kx] += a.real() * b.real() + a.imag() * b.imag();
        im[kx] += a.real() * b.imag() - a.imag() * b.real();
        energy[kx] += b.real() * b.real() + b.imag() * b.imag();
      }
    }
  }
};

/// Of a row of bins: T* α̂_k for every k, Σ_k |α̂_k|² and sqrt(Σ_k |T* α̂_k|²).
struct RowOverlap {
  std::vector<RowProducts> products;
  std::vector<double> energy, overlap;

  RowOverlap(const Spectrum& target, const std::vector<Spectrum>& coefficients, int ky)
      : energy(static_cast<std::size_t>(target.columns())), overlap(energy.size()) {
    products.reserve(coefficients.size());
    for (const Spectrum& spectrum : coefficients) {
      const RowProducts& row = products.emplace_back(target, spectrum, ky, energy);
      for (std::size_t kx = 0; kx < overlap.size(); ++kx) {
        overlap[kx] += row.re[kx] * row.re[kx] + row.im[kx] * row.im[kx];
      }
    }
    for (double& s : overlap) {
      s = std::sqrt(s);
    }
  }
};

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
    spectra.push_back(forward_fft_of_box(image, target_.raster()));
  }
  return spectra;
}

double TransportObjective::evaluate(std::span<const double> kernels, std::span<double> gradient) const {
  std::vector<Spectrum> spectra = transform(kernels);
  // Row by row: the value's terms, and α̂_k becomes g (g α̂_k − T (T* α̂_k) / s), s the overlap without the gain g.
  const double sum = sum_of_rows(target_.rows(), [&](int ky) {
    const RowOverlap row(target_, spectra, ky);
    std::vector<double> gain;
    std::vector<double> inverse_overlap;
    gain.reserve(row.energy.size());
    inverse_overlap.reserve(row.energy.size());
    double row_sum = 0;
    for (int kx = 0; kx < target_.columns(); ++kx) {
      const auto i = static_cast<std::size_t>(kx);
      gain.push_back(gain_.column(kx) * gain_.row(ky));
      // Where T is orthogonal to every kernel (or zero) the second term has no slope to offer.
      inverse_overlap.push_back(row.overlap[i] > 0 ? 1 / row.overlap[i] : 0);
      if (kx > 0 || ky > 0) {
        row_sum += target_.multiplicity(kx) * gain[i] * (gain[i] * row.energy[i] - 2 * row.overlap[i]);
      }
    }
    for (std::size_t k = 0; k < spectra.size(); ++k) {
      const RowProducts& product = row.products[k];
      for (int c = 0; c < target_.channels(); ++c) {
        const auto target = target_.row(c, ky);
        const auto bins = spectra[k].row(c, ky);
        for (std::size_t i = 0; i < bins.size(); ++i) {
          const Bin t(target[i]);
          const Bin h(bins[i]);
          const double re = product.re[i] * inverse_overlap[i];
          const double im = product.im[i] * inverse_overlap[i];
          bins[i] = {static_cast<float>(gain[i] * (gain[i] * h.real() - (t.real() * re - t.imag() * im))),
                     static_cast<float>(gain[i] * (gain[i] * h.imag() - (t.real() * im + t.imag() * re)))};
        }
      }
    }
    return row_sum;
  });
  for (std::size_t k = 0; k < spectra.size(); ++k) {
    for (int c = 0; c < target_.channels(); ++c) {
      spectra[k].at(c, 0, 0) = 0;
    }
    const Image sum_over_bins =
        unnormalized_inverse_fft_in_box(spectra[k], support_.box(), [](int, const BinBlock&) {});
    support_.gather(sum_over_bins, 2 / (variance_ * static_cast<double>(target_.raster().area())),
                    gradient.subspan(k * support_.size(), support_.size()));
  }
  return 1 + sum / (variance_ * static_cast<double>(target_.raster().area()));
}

std::vector<double> TransportObjective::overlap(std::span<const double> kernels) const {
  const std::vector<Spectrum> spectra = transform(kernels);
  std::vector<double> s(static_cast<std::size_t>(target_.bins()));
  parallel_for(target_.rows(), [&](int ky) {
    const RowOverlap row(target_, spectra, ky);
    for (int kx = ky == 0 ? 1 : 0; kx < target_.columns(); ++kx) {
      s[static_cast<std::size_t>(ky) * static_cast<std::size_t>(target_.columns()) + static_cast<std::size_t>(kx)] =
          gain_.column(kx) * gain_.row(ky) * row.overlap[static_cast<std::size_t>(kx)];
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
