#include "methods/sparse/gabor_fit.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace textonbench {
namespace {

/// Eigenvectors of a kernel's part below this share of it are left out.
constexpr double least_share = 1e-3;

/// P_cd / q at the stored bins.
std::vector<Spectrum> relative_products(const GaborTarget& target, const Image& model) {
  Image one(model.extent(), 1);
  for (int y = 0; y < one.height(); ++y) std::ranges::fill(one.row(0, y), 1.0F);
  const Image inverse = power_ratio(one, model);
  std::vector<Spectrum> products = target.products;
  for (Spectrum& product : products) {
    for (int y = 0; y < product.rows(); ++y) {
      for (int x = 0; x < product.columns(); ++x) product.at(0, x, y) *= inverse.at(0, x, y);
    }
  }
  return products;
}

/// Whether a stored bin is the one of the pair (k, −k) that is taken.
bool is_taken(Extent raster, int kx, int ky) {
  return 2 * kx < raster.width && kx > 0 ? true : 2 * ky <= raster.height;
}

GaborFrequency bin_frequency(Extent raster, int kx, int ky) {
  const int signed_ky = 2 * ky > raster.height ? ky - raster.height : ky;
  return {static_cast<double>(kx) / raster.width, static_cast<double>(signed_ky) / raster.height};
}

/// Parts of the kernels of one band.
FittedBand band_parts(const GaborDictionary& dictionary, const std::vector<Spectrum>& products, int channels,
                      const Image& coefficients, int band, const GaborWindow& window) {
  FittedBand fitted{.window = window, .raster = dictionary.raster(), .frequency = {}, .part = {}};
  std::vector<Spectrum> explained;
  explained.reserve(products.size());
  for (const Spectrum& product : products) explained.push_back(dictionary.correlate(product, band));
  const Spectrum& first = explained.front();
  for (int y = 0; y < first.rows(); ++y) {
    for (int x = 0; x < first.columns(); ++x) {
      const double c = coefficients.at(band, x, y);
      if (!(c > 0) || !is_taken(dictionary.raster(), x, y)) continue;
      const double scale = first.self_conjugate(x, y) ? c : 2 * c;
      Eigen::MatrixXcd part(channels, channels);
      for (int i = 0; i < channels; ++i) {
        for (int j = 0; j <= i; ++j) {
          const std::complex<double> v(explained[color_pair_of(i, j)].at(0, x, y));
          part(i, j) = scale * v;
          part(j, i) = scale * std::conj(v);
        }
      }
      if (!(part.trace().real() > 0)) continue;
      fitted.frequency.push_back(bin_frequency(dictionary.raster(), x, y));
      fitted.part.push_back(std::move(part));
    }
  }
  return fitted;
}

/// Colors c_1, …, c_n of a kernel, all of one norm, with (1/n) Σ_m c_m c_m* = its part. Of its eigenvectors v_j and
/// eigenvalues μ_j they are Σ_j sqrt(μ_j) exp(2πi j m / n) v_j: so none stands alone in a rare impact of an odd color.
std::vector<Eigen::VectorXcd> spread_colors(const Eigen::MatrixXcd& vectors, const Eigen::VectorXd& variances) {
  std::vector<Eigen::VectorXcd> kept;
  double sum = 0;
  for (Eigen::Index j = variances.size() - 1; j >= 0; --j) {
    if (!(variances[j] > least_share * variances.sum())) continue;
    kept.emplace_back(std::sqrt(variances[j]) * vectors.col(j));
    sum += variances[j];
  }
  const double scale = std::sqrt(variances.sum() / sum);
  std::vector<Eigen::VectorXcd> colors;
  colors.reserve(kept.size());
  for (std::size_t m = 0; m < kept.size(); ++m) {
    Eigen::VectorXcd color = Eigen::VectorXcd::Zero(vectors.rows());
    for (std::size_t j = 0; j < kept.size(); ++j) {
      const double turn = static_cast<double>(j * m) / static_cast<double>(kept.size());
      color += std::polar(scale, 2 * std::numbers::pi * turn) * kept[j];
    }
    colors.push_back(std::move(color));
  }
  return colors;
}

std::vector<Eigen::VectorXcd> kernel_colors(const Eigen::MatrixXcd& part) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXcd> solver(part);
  return spread_colors(solver.eigenvectors(), solver.eigenvalues().cwiseMax(0));
}

/// The same of what axes keep of it.
std::vector<Eigen::VectorXcd> kernel_colors(const Eigen::MatrixXcd& part, const Eigen::MatrixXd& axes) {
  const Eigen::MatrixXcd vectors = axes.cast<std::complex<double>>();
  return spread_colors(vectors, (vectors.adjoint() * part * vectors).diagonal().real().cwiseMax(0));
}

Eigen::MatrixXd color_axes(const GaborFit& fit, int channels) {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(channels, channels);
  for (const FittedBand& band : fit.bands) {
    for (const Eigen::MatrixXcd& part : band.part) sum += part.real();
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(sum).eigenvectors();
}

GaborBand impact_band(const FittedBand& fitted, double mni, const FitFieldOptions& options,
                      const Eigen::MatrixXd& axes) {
  GaborBand band;
  band.window = fitted.window;
  band.raster = fitted.raster;
  band.cell = std::sqrt(band.window.half_width() * band.window.half_height());
  band.intensity = ImpactGrid(options.process, mni / band.window.area(), band.cell, 1).intensity();
  std::vector<double> weights;
  std::vector<Eigen::VectorXcd> colors;
  for (std::size_t k = 0; k < fitted.part.size(); ++k) {
    const auto own = options.axes ? kernel_colors(fitted.part[k], axes) : kernel_colors(fitted.part[k]);
    for (const Eigen::VectorXcd& color : own) {
      band.frequency.push_back(fitted.frequency[k]);
      weights.push_back(color.squaredNorm() / static_cast<double>(own.size()));
      colors.push_back(color.normalized());
    }
  }
  band.draw_by(weights);
  const double amplitude = std::sqrt(2 * fitted.variance() / (band.intensity * band.window.energy()));
  band.color.reserve(colors.size() * static_cast<std::size_t>(axes.rows()));
  for (const Eigen::VectorXcd& color : colors) {
    for (Eigen::Index c = 0; c < color.size(); ++c) band.color.emplace_back(amplitude * color[c]);
  }
  return band;
}

}  // namespace

double FittedBand::variance() const {
  double sum = 0;
  for (const Eigen::MatrixXcd& kernel : part) sum += kernel.trace().real();
  return sum;
}

std::size_t GaborFit::kernels() const {
  std::size_t sum = 0;
  for (const FittedBand& band : bands) sum += band.part.size();
  return sum;
}

std::vector<GaborWindow> band_windows(Extent raster, const BandOptions& options) {
  // A power of standard deviation s has the bandwidth 2 sqrt(π) s.
  const double bin = 1 / std::sqrt(static_cast<double>(raster.area()));
  std::vector<GaborWindow> windows;
  for (int b = 0; b < options.bands; ++b) {
    const double deviation = options.finest * bin * std::pow(options.ratio, b);
    const GaborWindow window = GaborWindow::round(2 * std::sqrt(std::numbers::pi) * deviation, options.cut);
    if (window.half_width() >= 1) windows.push_back(window);
  }
  return windows;
}

GaborFit fit_pursuit(const GaborTarget& target, const BandOptions& bands, const PursuitOptions& options) {
  const std::vector<GaborWindow> windows = band_windows(target.raster(), bands);
  const GaborDictionary dictionary(target.raster(), windows);
  PursuitOptions scattered = options;
  scattered.scatter = target.scatter;
  Pursuit found = pursue(dictionary, target.power, scattered);
  const std::vector<Spectrum> products = relative_products(target, dictionary.sum(found.coefficients));
  GaborFit fit{.bands = {}, .rme = std::move(found.rme), .residual = found.residual, .reason = found.reason};
  double variance = 0;
  for (std::size_t b = 0; b < windows.size(); ++b) {
    FittedBand band =
        band_parts(dictionary, products, target.channels(), found.coefficients, static_cast<int>(b), windows[b]);
    variance += band.variance();
    if (!band.part.empty()) fit.bands.push_back(std::move(band));
  }
  // Where the model has no power to speak of, no kernel explains what there is.
  const double missing = target.covariance().trace() / variance;
  for (FittedBand& band : fit.bands) {
    for (Eigen::MatrixXcd& part : band.part) part *= missing;
  }
  return fit;
}

GaborField fitted_field(const GaborFit& fit, int channels, const FitFieldOptions& options) {
  GaborField field{.channels = channels,
                   .process = options.process,
                   .phase = GaborPhase::random,
                   .weight = GaborWeight::impacts,
                   .bands = {}};
  const Eigen::MatrixXd axes = color_axes(fit, channels);
  double roots = 0;
  for (const FittedBand& band : fit.bands) roots += std::sqrt(band.variance());
  for (const FittedBand& band : fit.bands) {
    field.bands.push_back(impact_band(band, options.mni * std::sqrt(band.variance()) / roots, options, axes));
  }
  return field;
}

}  // namespace textonbench
