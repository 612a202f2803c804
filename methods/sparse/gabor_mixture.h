// A power as a sum of few Gaussians of any shape.
#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

#include "methods/base/image.h"

namespace textonbench {

/// weight (N(ξ − center; covariance) + N(ξ + center; covariance)) / 2 on the torus of frequencies, cycles a pixel.
struct PowerGaussian {
  double weight = 0;
  Eigen::Vector2d center{0, 0};
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
};

/// Merges pairs of Gaussians until at most so many are left: the pair first that raises Runnalls' bound least (IEEE
/// Trans. Aerospace and Electronic Systems 43, 2007). A Gaussian may be merged as the one of −center.
std::vector<PowerGaussian> merge_gaussians(std::vector<PowerGaussian> all, int count);

struct PowerMixture {
  std::vector<PowerGaussian> gaussians;
  std::vector<double> rme;  ///< of the power, after each step
  std::string_view reason;  ///< "tolerance", "no descent" or "iterations"
};

/// Deviations of a Gaussian stay in [least, most], cycles a pixel.
struct MixtureBounds {
  double least = 0;
  double most = 0.25;
};

/// Fits weights, centers and covariances to a power (whole plane, even; bin 0 is left out),
///
///   min Σ_ξ (sqrt q(ξ) − sqrt p(ξ))²,   q(ξ) the Gaussians at the bins over the number of bins,
///
/// from where they are, by Levenberg and Marquardt.
PowerMixture fit_gaussians(const std::vector<PowerGaussian>& start, const Image& power, const MixtureBounds& bounds,
                           int iterations);

/// The Gaussians' power on a raster, whole plane.
Image mixture_power(const std::vector<PowerGaussian>& gaussians, Extent raster);

}  // namespace textonbench
