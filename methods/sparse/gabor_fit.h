// Gabor noise whose power is fitted to an exemplar's: kernels of a few quantized windows (Galerne, Lagae, Lefebvre,
// Drettakis, SIGGRAPH 2012), or fewer ones each with a window of its own.
#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

#include "methods/base/impact_grid.h"
#include "methods/sparse/gabor_field.h"
#include "methods/sparse/gabor_pursuit.h"
#include "methods/sparse/gabor_target.h"

namespace textonbench {

/// Kernels of one window. A kernel stands for a frequency and its negative.
struct FittedBand {
  GaborWindow window;
  Extent raster{};  ///< as in GaborBand
  std::vector<GaborFrequency> frequency;
  /// Hermitian part of P that is each kernel's: Σ Re of all is the covariance of the colors.
  std::vector<Eigen::MatrixXcd> part;

  double variance() const;
};

struct GaborFit {
  std::vector<FittedBand> bands;
  std::vector<double> rme;  ///< relative model error of the power after each iteration
  double residual = 0;      ///< as in Pursuit
  std::string_view reason;  ///< why iterations ended: "tolerance", "no descent" or "iterations"

  std::size_t kernels() const;
};

/// Windows of bandwidths in geometric progression, without those whose radius is below a pixel.
struct BandOptions {
  int bands = 5;
  double finest = 0.5;  ///< standard deviation of the narrowest band's power, bins of the target's raster
  double ratio = 2;     ///< of one band's bandwidth to the one before
  double cut = 0.01;
};

std::vector<GaborWindow> band_windows(Extent raster, const BandOptions& options);

/// Sparse kernels on centers of the raster, by pursue(). The part of each is what it explains of P: with r its part of
/// the model's power at each bin, Σ_ξ r P. So the parts sum to all of P, phases between channels included.
GaborFit fit_pursuit(const GaborTarget& target, const BandOptions& bands, const PursuitOptions& options);

struct MixtureOptions {
  int kernels = 24;
  int iterations = 60;
};

/// At most so many kernels with elliptic windows. Those of a pursuit are merged in pairs, the pair first whose merging
/// raises the bound of Runnalls on the Kullback–Leibler divergence least (IEEE Trans. Aerospace and Electronic Systems
/// 43, 2007), and then amplitudes, centers and covariances are fitted to
///
///   min Σ_ξ (sqrt q(ξ) − sqrt p(ξ))²,   q(ξ) = Σ_k a_k (N(ξ − F_k; S_k) + N(ξ + F_k; S_k)),
///
/// the optimal-transport distance of the powers, by Levenberg and Marquardt within bounds (Ceres).
GaborFit fit_mixture(const GaborTarget& target, const GaborFit& pursuit, const MixtureOptions& options);

struct FitFieldOptions {
  double mni = 40;  ///< impacts at a point on average, of all bands
  ImpactProcess process = ImpactProcess::stratified;
  bool axes = false;  ///< colors are the axes of the color covariance instead of vectors of each kernel
};

/// Impacts are shared among bands by the roots of their variances. A kernel is drawn with the probability of its part
/// of the band's variance, in one of a few colors of one norm whose mean product is its part, all with one amplitude.
GaborField fitted_field(const GaborFit& fit, int channels, const FitFieldOptions& options);

}  // namespace textonbench
