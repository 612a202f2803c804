// Second-order law of a stationary colour texture: mean and cross-spectrum, and the optimal-transport distance between
// two such laws.
//
// Scaling. On a torus of |Ω| pixels the cross-spectrum P(ξ) is the C x C Hermitian matrix
//
//   P(ξ) = Σ_x Γ(x) exp(−2πi <ξ, x>),   Γ(x)_{cd} = Cov(U_c(x), U_d(0)),
//
// so Γ(0) = (1/|Ω|) Σ_ξ P(ξ). For the Gaussian model of an exemplar u, P = t̂ t̂* with the normalised spot
// t = (u − mean) / sqrt(|Ω|). P is kept as a sum of at most C factors, P(ξ) = Σ_k ĥ_k(ξ) ĥ_k(ξ)*.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "methods/base/fft.h"
#include "methods/base/image.h"

namespace textonbench {

/// P(ξ) = Σ_k ĥ_k(ξ) ĥ_k(ξ)*, one Spectrum (of C channels) a factor. At least one factor, all of the same size.
struct CrossSpectrum {
  std::vector<Spectrum> factors;

  Extent grid() const { return factors.front().raster(); }
  int channels() const { return factors.front().channels(); }
};

/// The cross-spectrum of C channels whose entries P_cd, d <= c, are channel 0 of products[c (c + 1) / 2 + d];
/// eigenvalues below zero (rounding) count as zero. Throws std::invalid_argument unless there are C (C + 1) / 2
/// products.
CrossSpectrum factor_products(std::span<const Spectrum> products, int channels);

/// Gaussian model of an exemplar: mean, and cross-spectrum of rank one with P(0) = 0.
struct GaussianModel {
  std::vector<double> mean;
  CrossSpectrum spectrum;
};

/// Mean m and normalised spot t̂ of u, DC set to zero. `u` is taken as a torus: pass the periodic component unless the
/// border's cross is wanted.
GaussianModel gaussian_model(Image u);

/// C x C covariance at lag zero, Γ(0) = (1/|Ω|) Σ_ξ P(ξ).
Eigen::MatrixXd color_covariance(const CrossSpectrum& p);

/// Γ_{cd}(v) for all lags v of the torus; entry (c, d) of the result is at c * C + d, an image with lag (0, 0) at
/// pixel (0, 0) and Γ_{cd}(v) = Γ_{dc}(−v). Entries are double precision, row by row.
struct Autocovariance {
  Extent grid;
  int channels = 0;
  std::vector<std::vector<double>> planes;
  /// Γ_{cd}(x, y), lags taken modulo the grid.
  double at(int c, int d, int x, int y) const;
};
Autocovariance autocovariance(const CrossSpectrum& p);

/// Squared Gaussian optimal-transport (Wasserstein-2) distance a pixel between the stationary laws on the torus,
///
///   (1/|Ω|) Σ_ξ [ tr P + tr Q − 2 tr (P^{1/2} Q P^{1/2})^{1/2} ],
///
/// the mean (ξ = 0) excluded. Closed form when both have rank one (EUSIPCO 2014, eq. 1): the last term is
/// 2 |p̂* q̂|; otherwise the Bures formula by eigen-decomposition in double precision. Throws std::invalid_argument
/// when sizes or channels differ.
double transport_distance_squared(const CrossSpectrum& p, const CrossSpectrum& q);

/// RME(p | target) = sqrt(transport_distance_squared(p, target) / tr Γ_target(0)), in [0, 1] for an optimally scaled p.
double relative_model_error(const CrossSpectrum& p, const CrossSpectrum& target);

/// The formula as printed in EUSIPCO 2014, without the factor 2 on the cross term. Kept for the ledger: it is close
/// to 1 for any p of unit relative energy and cannot give the paper's own numbers.
double relative_model_error_as_printed(const CrossSpectrum& p, const CrossSpectrum& target);

/// Bures (optimal-transport) distance between two covariance matrices, squared: tr A + tr B − 2 tr (A^{1/2} B
/// A^{1/2})^{1/2}. Eigenvalues below zero (rounding) count as zero.
double bures_distance_squared(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

}  // namespace textonbench
