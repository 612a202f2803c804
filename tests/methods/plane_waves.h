// Float64 oracles of the optimal textons: dense matrices over the pixels of a small support, no fast transforms.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "methods/base/gaussian_model.h"
#include "methods/base/random.h"
#include "tests/texture.h"

namespace textonbench {

inline Image full_mask(Extent box) {
  Image mask(box, 1);
  for (int y = 0; y < box.height; ++y) {
    std::ranges::fill(mask.row(0, y), 1.0F);
  }
  return mask;
}

/// A box without two of its corners, and with a hole.
inline Image ragged_mask(Extent box) {
  Image mask = full_mask(box);
  mask.at(0, 0, 0) = 0;
  mask.at(0, box.width - 1, box.height - 1) = 0;
  mask.at(0, box.width / 2, box.height / 2) = 0;
  return mask;
}

inline std::vector<double> random_kernels(std::size_t size, double variance, std::uint64_t seed) {
  RandomSequence random(Stream(Seed{seed}).child("kernels"));
  std::vector<double> x(size);
  for (double& v : x) {
    v = std::sqrt(variance / static_cast<double>(size)) * random.normal();
  }
  return x;
}

/// The vectors a(ξ), ξ ≠ 0, with T* ĥ = a* h for h on the support (channel by channel), one a row of `overlaps`
/// conjugated; and the matrix of Σ_{ξ≠0} |ĥ|² = |Ω| h* N h.
struct PlaneWaves {
  PlaneWaves(const Spectrum& target, const Image& mask) : pixels(static_cast<double>(target.raster().area())) {
    const auto [w, h] = target.raster();
    std::vector<std::pair<int, int>> inside;
    for (int y = 0; y < mask.height(); ++y) {
      for (int x = 0; x < mask.width(); ++x) {
        if (mask.at(0, x, y) != 0) {
          inside.emplace_back(x, y);
        }
      }
    }
    const auto n = static_cast<Eigen::Index>(inside.size());
    const int channels = target.channels();
    norm = Eigen::MatrixXd::Identity(channels * n, channels * n);
    overlaps.resize(w * h - 1, channels * n);
    Eigen::Index row = 0;
    for (int ky = 0; ky < h; ++ky) {
      for (int kx = ky == 0 ? 1 : 0; kx < w; ++kx, ++row) {
        const bool stored = kx < target.columns();
        for (int c = 0; c < channels; ++c) {
          const std::complex<double> t(stored ? target.at(c, kx, ky) : std::conj(target.at(c, w - kx, (h - ky) % h)));
          energy += std::norm(t);
          for (Eigen::Index i = 0; i < n; ++i) {
            const auto [x, y] = inside[static_cast<std::size_t>(i)];
            const double phase = -2 * std::numbers::pi * (kx * x / double(w) + ky * y / double(h));
            overlaps(row, c * n + i) = std::conj(t) * std::polar(1.0, phase);
          }
        }
      }
    }
    for (int c = 0; c < channels; ++c) {
      norm.block(c * n, c * n, n, n).array() -= 1 / pixels;
    }
  }

  /// s(ξ) of kernels that are the columns of H.
  Eigen::VectorXd overlap(const Eigen::MatrixXd& kernels) const { return (overlaps * kernels).rowwise().norm(); }
  /// Σ_ξ |T* ĥ|² / s = |Ω| h* M h.
  Eigen::MatrixXd quotient(const Eigen::VectorXd& s) const {
    return (overlaps.adjoint() * s.cwiseInverse().asDiagonal() * overlaps).real() / pixels;
  }
  double squared_error(const Eigen::MatrixXd& kernels) const {
    return 1 + (pixels * (kernels.transpose() * norm * kernels).trace() - 2 * overlap(kernels).sum()) / energy;
  }
  Eigen::MatrixXd columns(const std::vector<double>& kernels) const {
    const Eigen::Index n = overlaps.cols();
    return Eigen::Map<const Eigen::MatrixXd>(kernels.data(), n, static_cast<Eigen::Index>(kernels.size()) / n);
  }

  double pixels;
  double energy = 0;
  Eigen::MatrixXcd overlaps;
  Eigen::MatrixXd norm;
};

inline Spectrum spot_spectrum(Extent extent, int channels, std::uint64_t seed = 1) {
  return gaussian_model(test_texture(extent, channels, seed)).spectrum.factors.front();
}

}  // namespace textonbench
