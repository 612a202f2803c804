#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "methods/base/parallel.h"
#include "methods/sparse/gabor_fit.h"
#include "methods/sparse/gabor_mixture.h"

namespace textonbench {
namespace {

/// Kernels of a pursuit with less of the variance are left out before the others are merged.
constexpr double least_part = 1e-4;
/// Windows reach at most so far.
constexpr double widest_window = 512;

/// A power of this covariance has the window with A = 4π times it.
constexpr double form_of_covariance = 4 * std::numbers::pi;

std::vector<PowerGaussian> pursuit_gaussians(const GaborFit& pursuit) {
  double variance = 0;
  for (const FittedBand& band : pursuit.bands) variance += band.variance();
  std::vector<PowerGaussian> gaussians;
  for (const FittedBand& band : pursuit.bands) {
    for (std::size_t k = 0; k < band.part.size(); ++k) {
      const double weight = band.part[k].trace().real();
      if (!(weight > least_part * variance)) continue;
      Eigen::Matrix2d form;
      form << band.window.xx, band.window.xy, band.window.xy, band.window.yy;
      gaussians.push_back({weight, {band.frequency[k].x, band.frequency[k].y}, form / form_of_covariance});
    }
  }
  return gaussians;
}

/// P / q at any bin, q having been divided out.
Eigen::MatrixXcd matrix_at(const std::vector<Spectrum>& products, int channels, int x, int y) {
  const Extent raster = products.front().raster();
  const bool is_stored = x < products.front().columns();
  const int kx = is_stored ? x : raster.width - x, ky = is_stored || y == 0 ? y : raster.height - y;
  Eigen::MatrixXcd p(channels, channels);
  for (int c = 0; c < channels; ++c) {
    for (int d = 0; d <= c; ++d) {
      const std::complex<double> v(products[color_pair_of(c, d)].at(0, kx, ky));
      p(c, d) = is_stored ? v : std::conj(v);
      p(d, c) = std::conj(p(c, d));
    }
  }
  return p;
}

/// Twice the part of P that half a Gaussian, the one around its center, explains.
Eigen::MatrixXcd explained_part(const PowerGaussian& gaussian, const GaborTarget& target, const Image& ratio) {
  const Extent raster = target.raster();
  const Eigen::Matrix2d precision = gaussian.covariance.inverse();
  const double peak = gaussian.weight / (2 * std::numbers::pi * std::sqrt(gaussian.covariance.determinant())) /
                      static_cast<double>(raster.area());
  Eigen::MatrixXcd sum = Eigen::MatrixXcd::Zero(target.channels(), target.channels());
  for (int y = 0; y < raster.height; ++y) {
    for (int x = 0; x < raster.width; ++x) {
      Eigen::Vector2d away(static_cast<double>(x) / raster.width, static_cast<double>(y) / raster.height);
      away -= gaussian.center;
      for (double& d : away) d -= std::round(d);
      const double square = away.dot(precision * away);
      if (square > 60) continue;
      sum += peak * std::exp(-0.5 * square) * double{ratio.at(0, x, y)} *
             matrix_at(target.products, target.channels(), x, y);
    }
  }
  return sum;
}

/// With a deviation of at least that along every axis, not only along those of the coordinates.
Eigen::Matrix2d widened(const Eigen::Matrix2d& covariance, double least) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(covariance);
  const Eigen::Vector2d variances = solver.eigenvalues().cwiseMax(least * least);
  return solver.eigenvectors() * variances.asDiagonal() * solver.eigenvectors().transpose();
}

FittedBand band_of(const PowerGaussian& gaussian, double cut, Eigen::MatrixXcd part) {
  const Eigen::Matrix2d form = form_of_covariance * gaussian.covariance;
  FittedBand band;
  band.window = {.xx = form(0, 0), .xy = form(0, 1), .yy = form(1, 1), .cut = cut};
  band.frequency.push_back({gaussian.center.x(), gaussian.center.y()});
  band.part.push_back(std::move(part));
  return band;
}

}  // namespace

GaborFit fit_mixture(const GaborTarget& target, const GaborFit& pursuit, const MixtureOptions& options) {
  const Extent raster = target.raster();
  const double cut = pursuit.bands.front().window.cut;
  const double bin = 1 / std::sqrt(static_cast<double>(raster.area()));
  // The least deviation whose window still fits, and at least a third of a bin.
  const double narrowest = std::sqrt(-std::log(cut)) / (2 * std::numbers::pi * widest_window);
  const MixtureBounds bounds{.least = std::max(bin / 3, 1.01 * narrowest), .most = 0.5};
  PowerMixture mixture = fit_gaussians(merge_gaussians(pursuit_gaussians(pursuit), options.kernels), target.power,
                                       bounds, options.iterations);
  for (PowerGaussian& gaussian : mixture.gaussians) gaussian.covariance = widened(gaussian.covariance, bounds.least);
  Image one(raster, 1);
  for (int y = 0; y < raster.height; ++y) std::ranges::fill(one.row(0, y), 1.0F);
  const Image ratio = power_ratio(one, mixture_power(mixture.gaussians, raster));
  std::vector<Eigen::MatrixXcd> parts(mixture.gaussians.size());
  parallel_for(static_cast<int>(parts.size()), [&](int k) {
    const auto at = static_cast<std::size_t>(k);
    parts[at] = explained_part(mixture.gaussians[at], target, ratio);
  });
  double variance = 0;
  for (const Eigen::MatrixXcd& part : parts) variance += part.trace().real();
  GaborFit fit{.bands = {}, .rme = std::move(mixture.rme), .residual = 0, .reason = mixture.reason};
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (!(parts[k].trace().real() > least_part * least_part * variance)) continue;
    fit.bands.push_back(band_of(mixture.gaussians[k], cut, parts[k] * (target.covariance().trace() / variance)));
  }
  return fit;
}

}  // namespace textonbench
