#include "methods/sparse/gabor_target.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <stdexcept>

#include "methods/base/gaussian_model.h"
#include "methods/base/spectrum.h"
#include "methods/base/welch.h"
#include "methods/sparse/gabor_field.h"

namespace textonbench {
namespace {

/// Spectra of the pairs of channels, of what `product_at` gives at a stored bin.
template <class ProductAt>
std::vector<Spectrum> pair_spectra(Extent raster, int channels, const ProductAt& product_at) {
  std::vector<Spectrum> products;
  const double scale = 1 / static_cast<double>(raster.area());
  for (int c = 0; c < channels; ++c) {
    for (int d = 0; d <= c; ++d) {
      Spectrum& product = products.emplace_back(raster, 1);
      for (int y = 0; y < product.rows(); ++y) {
        for (int x = 0; x < product.columns(); ++x) {
          product.at(0, x, y) = std::complex<float>(scale * std::complex<double>(product_at(c, d, x, y)));
        }
      }
      product.at(0, 0, 0) = 0;
    }
  }
  return products;
}

Image trace_of(const std::vector<Spectrum>& products, int channels) {
  const Extent raster = products.front().raster();
  Image power(raster, 1);
  for (int y = 0; y < raster.height; ++y) {
    for (int x = 0; x < raster.width; ++x) {
      const bool is_stored = x < products.front().columns();
      const int kx = is_stored ? x : raster.width - x, ky = is_stored || y == 0 ? y : raster.height - y;
      float sum = 0;
      for (int c = 0; c < channels; ++c) {
        sum += products[color_pair_of(c, c)].at(0, kx, ky).real();
      }
      power.at(0, x, y) = std::max(0.0F, sum);
    }
  }
  return power;
}

}  // namespace

Eigen::MatrixXd GaborTarget::covariance() const {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(channels(), channels());
  std::size_t pair = 0;
  for (int c = 0; c < channels(); ++c) {
    for (int d = 0; d <= c; ++d, ++pair) {
      const Spectrum& product = products[pair];
      for (int y = 0; y < product.rows(); ++y) {
        for (int x = 0; x < product.columns(); ++x) {
          sum(c, d) += product.multiplicity(x) * double{product.at(0, x, y).real()};
        }
      }
    }
  }
  return sum.selfadjointView<Eigen::Lower>();
}

Extent gabor_raster(Extent exemplar, int side) {
  if (std::max(exemplar.width, exemplar.height) <= side) return exemplar;
  const int block = std::min(welch_side(exemplar), static_cast<int>(std::bit_floor(static_cast<unsigned>(side))));
  return {block, block};
}

GaborTarget gabor_target(const Exemplar& exemplar, int side) {
  require_usable(exemplar);
  const Image& u = exemplar.pixels;
  GaborTarget target;
  const Extent raster = gabor_raster(u.extent(), side);
  if (raster == u.extent()) {
    const GaussianModel model = gaussian_model(periodic_component(u));
    const Spectrum& spot = model.spectrum.factors.front();
    target.mean = model.mean;
    target.products = pair_spectra(u.extent(), u.channels(), [&](int c, int d, int x, int y) {
      return spot.at(c, x, y) * std::conj(spot.at(d, x, y));
    });
  } else {
    const WelchSpectrum welch(u, {.side = raster.width});
    target.mean = welch.mean();
    const int n = welch.side();
    target.products = pair_spectra(
        {n, n}, u.channels(), [&](int c, int d, int x, int y) -> std::complex<double> { return welch.at(x, y)(c, d); });
    // Neighboring blocks share a half, and what they share is alike to (1/6)² after the taper (Welch 1967).
    target.scatter = std::min(1.0, 1.1 / static_cast<double>(welch.blocks().size()));
  }
  target.power = trace_of(target.products, u.channels());
  if (!(target.covariance().trace() > 0)) {
    throw std::invalid_argument("Gabor noise by example of an exemplar of one color: it has no power to fit");
  }
  return target;
}

}  // namespace textonbench
