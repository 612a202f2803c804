// A linear map of the color channels that gives a texton's noise the colors' covariance of the exemplar, which a small
// support loses in part (the papers' correction; the relative model error rises a little).
#pragma once

#include <Eigen/Core>

#include "methods/base/gaussian_model.h"
#include "methods/base/params.h"
#include "methods/base/texton.h"

namespace textonbench {

/// `authors`: K = B^{1/2} A^{−1/2}, the map of the authors' code. `transport`: K = A^{−1/2} (A^{1/2} B A^{1/2})^{1/2}
/// A^{−1/2}, of all maps the one that moves the colors least on average.
enum class ColorCorrection { none, authors, transport };

/// The option "color_correction" (none|authors|transport) and its value.
ParamSpec color_correction_param();
ColorCorrection color_correction_of(const Params& params);

/// The option for fits that can also keep the colors while they minimize: with the further choice "constrained".
ParamSpec constrainable_color_correction_param();

/// K with K A Kᵀ = B for covariances A and B of the channels; the identity for `none`. Directions in which A has less
/// than 1e-8 of its trace (all but one, for gray stored as RGB) carry no color: A^{−1/2} is zero there, so K A Kᵀ = B
/// holds on the others only, and wholly when B has no color there either. Throws std::invalid_argument for matrices
/// that are not finite, not square of one size, or when the trace of A is not positive.
Eigen::MatrixXd color_map(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, ColorCorrection correction);

/// Covariance of the texton's noise at lag zero, A = Σ_k Σ_x h_k(x) h_k(x)ᵀ; of the coefficients of B-splines of an
/// order above 0, A = Σ_k Σ_{x, j} b(j) α_k(x) α_k(x − j)ᵀ (spline_spectrum.h).
Eigen::MatrixXd color_covariance(const Texton& texton, int order = 0);

struct CorrectedTexton {
  Texton texton;
  Eigen::MatrixXd map;
  double rme_before = 0;
  double rme_after = 0;
};

/// Maps the colors of every pixel of every kernel, or coefficient of that order, by K, with B the target's covariance
/// of colors: that of the result is B to 1e-6 of its norm. Gray textons get the target's variance. Throws
/// std::invalid_argument as color_map does, or when the texton does not fit into the target's torus.
CorrectedTexton correct_colors(Texton texton, const CrossSpectrum& target, ColorCorrection correction, int order = 0);

}  // namespace textonbench
