#include "methods/base/gaussian_model.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "methods/base/parallel.h"
#include "methods/base/spectrum.h"

namespace textonbench {
namespace {

void require_alike(const CrossSpectrum& p, const CrossSpectrum& q) {
  if (p.grid() != q.grid() || p.channels() != q.channels()) {
    throw std::invalid_argument(
        fmt::format("cross-spectra of {}x{}x{} and {}x{}x{}: expected the same size and channels", p.grid().width,
                    p.grid().height, p.channels(), q.grid().width, q.grid().height, q.channels()));
  }
}

/// Σ_ξ f(ky, kx) over the full spectrum without ξ = 0.
template <class Function>
double sum_without_mean(const Spectrum& layout, const Function& f) {
  double total = 0;
  for (int ky = 0; ky < layout.rows(); ++ky) {
    double row_sum = 0;
    for (int kx = ky == 0 ? 1 : 0; kx < layout.columns(); ++kx) {
      row_sum += layout.multiplicity(kx) * f(kx, ky);
    }
    total += row_sum;
  }
  return total;
}

/// Σ_{ξ≠0} tr P(ξ).
double energy(const CrossSpectrum& p) {
  double total = 0;
  for (const Spectrum& factor : p.factors) {
    total += sum_without_mean(factor, [&](int kx, int ky) {
      double sum = 0;
      for (int c = 0; c < factor.channels(); ++c) {
        sum += std::norm(std::complex<double>(factor.at(c, kx, ky)));
      }
      return sum;
    });
  }
  return total;
}

std::complex<double> inner_product(const Spectrum& a, const Spectrum& b, int kx, int ky) {
  std::complex<double> sum = 0;
  for (int c = 0; c < a.channels(); ++c) {
    sum += std::conj(std::complex<double>(a.at(c, kx, ky))) * std::complex<double>(b.at(c, kx, ky));
  }
  return sum;
}

/// Σ_{ξ≠0} tr (P^{1/2} Q P^{1/2})^{1/2}. With P = A A* and Q = B B* the trace is the sum of the singular values of A*
/// B, a matrix of rank(P) x rank(Q): no square root of a matrix is needed.
double overlap(const CrossSpectrum& p, const CrossSpectrum& q) {
  const Spectrum& layout = p.factors.front();
  if (p.factors.size() == 1 && q.factors.size() == 1) {
    return sum_without_mean(layout,
                            [&](int kx, int ky) { return std::abs(inner_product(layout, q.factors.front(), kx, ky)); });
  }
  Eigen::MatrixXcd product(p.factors.size(), q.factors.size());
  return sum_without_mean(layout, [&](int kx, int ky) {
    for (std::size_t i = 0; i < p.factors.size(); ++i) {
      for (std::size_t j = 0; j < q.factors.size(); ++j) {
        product(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
            inner_product(p.factors[i], q.factors[j], kx, ky);
      }
    }
    return Eigen::JacobiSVD<Eigen::MatrixXcd>(product).singularValues().sum();
  });
}

Eigen::MatrixXd square_root(const Eigen::MatrixXd& a) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(a);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() *
         solver.eigenvectors().transpose();
}

double relative_error(const CrossSpectrum& p, const CrossSpectrum& target, double weight_of_overlap) {
  require_alike(p, target);
  const double of_target = energy(target);
  const double squared = energy(p) + of_target - weight_of_overlap * overlap(p, target);
  return std::sqrt(std::max(0.0, squared) / of_target);
}

}  // namespace

CrossSpectrum factor_products(std::span<const Spectrum> products, int channels) {
  const auto pair = [](int c, int d) {
    const auto row = static_cast<std::size_t>(c);
    return row * (row + 1) / 2 + static_cast<std::size_t>(d);
  };
  if (products.size() != pair(channels, 0)) {
    throw std::invalid_argument(fmt::format("{} products of spectra for {} channels: expected {}", products.size(),
                                            channels, pair(channels, 0)));
  }
  const Extent grid = products.front().raster();
  CrossSpectrum result;
  for (int k = 0; k < channels; ++k) result.factors.emplace_back(grid, channels);
  parallel_for(grid.height, [&](int ky) {
    Eigen::MatrixXcd matrix(channels, channels);
    for (int kx = 0; kx < products.front().columns(); ++kx) {
      for (int c = 0; c < channels; ++c) {
        for (int d = 0; d <= c; ++d) {
          matrix(c, d) = std::complex<double>(products[pair(c, d)].at(0, kx, ky));
          matrix(d, c) = std::conj(matrix(c, d));
        }
        matrix(c, c) = matrix(c, c).real();
      }
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXcd> solver(matrix);
      for (int k = 0; k < channels; ++k) {
        const double size = std::sqrt(std::max(0.0, solver.eigenvalues()[k]));
        for (int c = 0; c < channels; ++c) {
          result.factors[static_cast<std::size_t>(k)].at(c, kx, ky) =
              std::complex<float>(size * solver.eigenvectors()(c, k));
        }
      }
    }
  });
  return result;
}

GaussianModel gaussian_model(Image u) {
  GaussianModel model{channel_means(u), {}};
  // The mean is taken off first: rounding errors of a transform are in proportion to its largest coefficient.
  const double scale = 1.0 / std::sqrt(static_cast<double>(u.extent().area()));
  for (int c = 0; c < u.channels(); ++c) {
    const double mean = model.mean[static_cast<std::size_t>(c)];
    for (int y = 0; y < u.height(); ++y) {
      for (float& v : u.row(c, y)) {
        v = static_cast<float>((static_cast<double>(v) - mean) * scale);
      }
    }
  }
  Spectrum spot = forward_fft(u);
  for (int c = 0; c < spot.channels(); ++c) {
    spot.at(c, 0, 0) = 0;
  }
  model.spectrum.factors.push_back(std::move(spot));
  return model;
}

Eigen::MatrixXd color_covariance(const CrossSpectrum& p) {
  const int channels = p.channels();
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(channels, channels);
  for (const Spectrum& factor : p.factors) {
    for (int c = 0; c < channels; ++c) {
      for (int d = 0; d <= c; ++d) {
        covariance(c, d) += sum_without_mean(factor, [&](int kx, int ky) {
          return std::real(std::complex<double>(factor.at(c, kx, ky)) *
                           std::conj(std::complex<double>(factor.at(d, kx, ky))));
        });
      }
    }
  }
  covariance /= static_cast<double>(p.grid().area());
  return covariance.selfadjointView<Eigen::Lower>();
}

double Autocovariance::at(int c, int d, int x, int y) const {
  const auto wrap = [](int v, int n) { return ((v % n) + n) % n; };
  return planes[static_cast<std::size_t>(c) * static_cast<std::size_t>(channels) + static_cast<std::size_t>(d)]
               [static_cast<std::size_t>(wrap(y, grid.height)) * static_cast<std::size_t>(grid.width) +
                static_cast<std::size_t>(wrap(x, grid.width))];
}

Autocovariance autocovariance(const CrossSpectrum& p) {
  const int channels = p.channels();
  const Extent grid = p.grid();
  Autocovariance result{
      grid, channels,
      std::vector<std::vector<double>>(static_cast<std::size_t>(channels) * static_cast<std::size_t>(channels))};
  for (int c = 0; c < channels; ++c) {
    for (int d = 0; d < channels; ++d) {
      Spectrum product(grid, 1);
      for (const Spectrum& factor : p.factors) {
        for (int ky = 0; ky < product.rows(); ++ky) {
          const auto a = factor.row(c, ky);
          const auto b = factor.row(d, ky);
          const auto out = product.row(0, ky);
          for (std::size_t kx = 0; kx < out.size(); ++kx) {
            out[kx] += a[kx] * std::conj(b[kx]);
          }
        }
      }
      product.at(0, 0, 0) = 0;
      const Image covariance = inverse_fft(product);
      auto& plane =
          result.planes[static_cast<std::size_t>(c) * static_cast<std::size_t>(channels) + static_cast<std::size_t>(d)];
      plane.reserve(static_cast<std::size_t>(grid.area()));
      for (int y = 0; y < grid.height; ++y) {
        const auto row = covariance.row(0, y);
        plane.insert(plane.end(), row.begin(), row.end());
      }
    }
  }
  return result;
}

double transport_distance_squared(const CrossSpectrum& p, const CrossSpectrum& q) {
  require_alike(p, q);
  const double sum = energy(p) + energy(q) - 2 * overlap(p, q);
  return std::max(0.0, sum) / static_cast<double>(p.grid().area());
}

double relative_model_error(const CrossSpectrum& p, const CrossSpectrum& target) {
  return relative_error(p, target, 2);
}

double relative_model_error_as_printed(const CrossSpectrum& p, const CrossSpectrum& target) {
  return relative_error(p, target, 1);
}

double bures_distance_squared(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  const Eigen::MatrixXd product = square_root(a) * square_root(b);
  const double trace = Eigen::JacobiSVD<Eigen::MatrixXd>(product).singularValues().sum();
  return std::max(0.0, a.trace() + b.trace() - 2 * trace);
}

}  // namespace textonbench
