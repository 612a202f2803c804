#include "methods/spot/certificate.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <stdexcept>
#include <vector>

namespace textonbench {
namespace {

/// The operator of (1) in an orthonormal basis: g → N^{-1/2} M N^{-1/2} g, where M is the convolution with the inverse
/// transform of T T* / s and N = I − 1_S 1_S^T / |Ω| (for each channel) leaves ξ = 0 out of the norm.
class OverlapOperator {
 public:
  OverlapOperator(const TransportObjective& objective, const std::vector<double>& s)
      : support_(objective.support()),
        symbols_(symbols(objective, s)),
        scratch_(symbols_.front().raster(), channels()) {
    const double left =
        1 - static_cast<double>(support_.pixels()) / static_cast<double>(objective.target().raster().area());
    // Without the constants when S = Ω: they have no norm and no overlap.
    along_constants_ = left > 0 ? 1 / std::sqrt(left) : 0;
  }

  Eigen::Index size() const { return static_cast<Eigen::Index>(support_.size()); }

  void apply(const Eigen::VectorXd& in, Eigen::VectorXd& out) {
    out = in;
    scale_constants(out);
    support_.scatter({out.data(), support_.size()}, scratch_);
    const Spectrum spectrum = forward_fft(scratch_);
    Spectrum product(spectrum.raster(), channels());
    auto symbol = symbols_.begin();
    for (int c = 0; c < channels(); ++c) {
      for (int d = 0; d < channels(); ++d) {
        accumulate(*symbol++, spectrum, d, product, c);
      }
    }
    support_.gather(inverse_fft(product), 1, {out.data(), support_.size()});
    scale_constants(out);
  }

 private:
  int channels() const { return support_.channels(); }

  /// Transforms of the convolution kernels from channel d to channel c, at c C + d, on a torus that is just large
  /// enough for the differences of pixels of the support.
  static std::vector<Spectrum> symbols(const TransportObjective& objective, const std::vector<double>& s) {
    const Spectrum& target = objective.target();
    const Extent raster = target.raster();
    const Extent box = objective.support().box();
    const Extent torus{std::min(raster.width, good_fft_size(2 * box.width - 1)),
                       std::min(raster.height, good_fft_size(2 * box.height - 1))};
    std::vector<Spectrum> result;
    result.reserve(static_cast<std::size_t>(target.channels()) * static_cast<std::size_t>(target.channels()));
    for (int c = 0; c < target.channels(); ++c) {
      for (int d = 0; d < target.channels(); ++d) {
        Spectrum quotient(raster, 1);
        for (int ky = 0; ky < target.rows(); ++ky) {
          for (int kx = ky == 0 ? 1 : 0; kx < target.columns(); ++kx) {
            const double overlap = s[static_cast<std::size_t>(ky) * static_cast<std::size_t>(target.columns()) +
                                     static_cast<std::size_t>(kx)];
            if (overlap > 0) {
              quotient.at(0, kx, ky) =
                  std::complex<float>(std::complex<double>(target.at(c, kx, ky)) *
                                      std::conj(std::complex<double>(target.at(d, kx, ky))) / overlap);
            }
          }
        }
        result.push_back(forward_fft(wrap_lags(inverse_fft(quotient), box, torus)));
      }
    }
    return result;
  }

  /// Lags |x| < box.width, |y| < box.height of a torus image on another torus.
  static Image wrap_lags(const Image& lags, Extent box, Extent torus) {
    if (torus == lags.extent()) {
      return lags;
    }
    const auto first = [](int box_side, int side) { return side < 2 * box_side - 1 ? 0 : 1 - box_side; };
    const auto end = [](int box_side, int side) { return side < 2 * box_side - 1 ? side : box_side; };
    Image image(torus, 1);
    for (int y = first(box.height, torus.height); y < end(box.height, torus.height); ++y) {
      for (int x = first(box.width, torus.width); x < end(box.width, torus.width); ++x) {
        image.at(0, (x + torus.width) % torus.width, (y + torus.height) % torus.height) =
            lags.at(0, (x + lags.width()) % lags.width(), (y + lags.height()) % lags.height());
      }
    }
    return image;
  }

  static void accumulate(const Spectrum& symbol, const Spectrum& in, int from, Spectrum& out, int to) {
    for (int ky = 0; ky < out.rows(); ++ky) {
      const auto a = symbol.row(0, ky);
      const auto b = in.row(from, ky);
      const auto sum = out.row(to, ky);
      for (std::size_t kx = 0; kx < sum.size(); ++kx) {
        sum[kx] += std::complex<float>(a[kx].real() * b[kx].real() - a[kx].imag() * b[kx].imag(),
                                       a[kx].real() * b[kx].imag() + a[kx].imag() * b[kx].real());
      }
    }
  }

  /// g ← N^{-1/2} g: the mean of each channel over the support is scaled.
  void scale_constants(Eigen::VectorXd& g) const {
    const Eigen::Index pixels = support_.pixels();
    for (int c = 0; c < channels(); ++c) {
      auto channel = g.segment(c * pixels, pixels);
      channel.array() += (along_constants_ - 1) * channel.mean();
    }
  }

  const SupportPlane& support_;
  std::vector<Spectrum> symbols_;
  Image scratch_;
  double along_constants_ = 1;
};

/// Largest Ritz value of `steps` steps of Lanczos' method, without reorthogonalization: what rounding costs are
/// further copies of converged Ritz values, not the largest value itself.
double largest_ritz_value(OverlapOperator& a, int steps, Seed seed, int& steps_done) {
  Eigen::VectorXd v(a.size());
  RandomSequence random(Stream(seed).child("certificate"));
  for (double& x : v) {
    x = random.normal();
  }
  v.normalize();
  Eigen::VectorXd previous = Eigen::VectorXd::Zero(a.size());
  Eigen::VectorXd w;
  Eigen::VectorXd diagonal(steps);
  Eigen::VectorXd off_diagonal(steps);
  constexpr double invariant = 2e-6;  // residuals below it are rounding of the float32 transforms
  int step = 0;
  for (double beta = 0; step < steps; ++step) {
    a.apply(v, w);
    w -= beta * previous;
    diagonal[step] = v.dot(w);
    w -= diagonal[step] * v;
    beta = w.norm();
    off_diagonal[step] = beta;
    if (!(beta > invariant * diagonal.head(step + 1).maxCoeff())) {
      ++step;  // the start's whole invariant subspace is spanned
      break;
    }
    previous = v;
    v = w / beta;
  }
  steps_done = step;
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(diagonal.head(step), off_diagonal.head(step - 1), Eigen::EigenvaluesOnly);
  return solver.eigenvalues().maxCoeff();
}

}  // namespace

Certificate certify(const TransportObjective& objective, std::span<const double> kernels,
                    const CertificateOptions& options, Seed seed) {
  if (options.steps < 1 || !(options.failure_probability > 0 && options.failure_probability < 1)) {
    throw std::invalid_argument(
        fmt::format("certificate of {} steps and failure probability {}: expected at least 1 step and a number in "
                    "(0, 1)",
                    options.steps, options.failure_probability));
  }
  const Spectrum& target = objective.target();
  std::vector<double> s = objective.overlap(kernels);
  double sum = 0;
  for (int ky = 0; ky < target.rows(); ++ky) {
    for (int kx = ky == 0 ? 1 : 0; kx < target.columns(); ++kx) {
      double energy = 0;
      for (int c = 0; c < target.channels(); ++c) {
        energy += std::norm(std::complex<double>(target.at(c, kx, ky)));
      }
      double& overlap =
          s[static_cast<std::size_t>(ky) * static_cast<std::size_t>(target.columns()) + static_cast<std::size_t>(kx)];
      overlap = std::max(overlap, overlap_floor * energy);
      sum += target.multiplicity(kx) * overlap;
    }
  }

  OverlapOperator a(objective, s);
  Certificate result;
  result.ritz = largest_ritz_value(a, options.steps, seed, result.steps);
  const double root = std::log(1.648 * std::sqrt(static_cast<double>(a.size())) / options.failure_probability) /
                      (2.0 * options.steps - 1);
  constexpr double rounding = 1e-5;
  const double epsilon = root * root;
  result.lambda = epsilon < 1 ? result.ritz / (1 - epsilon) * (1 + rounding) : std::numeric_limits<double>::infinity();
  const double energy = objective.variance() * static_cast<double>(target.raster().area());
  result.bound = std::max(0.0, 1 - result.lambda * sum / energy);
  return result;
}

}  // namespace textonbench
