// Gabor noise seen through a Gaussian: kernels are filtered in closed form (Lagae, Lefebvre, Drettakis, Dutré, SIGGRAPH
// 2009), of any window and covariance.
//
// A kernel exp(−π y^T A y) exp(2πi f · y) convolved with the Gaussian density of covariance Σ is a kernel again. With
// S = 2πΣ it is h exp(−π f^T M f) exp(−π y^T A' y) exp(2πi f' · y), where
//
//   A'^−1 = A^−1 + S,   f' = A' A^−1 f,   M = A^−1 − A^−1 A' A^−1,   h = sqrt(det A' / det A).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "methods/base/params.h"
#include "methods/sparse/gabor_field.h"

namespace textonbench {

/// `field` convolved with the Gaussian of that covariance, pixels². Impacts, entries and phases are the same.
///
/// Kernels are filtered as if they were not cut, and then cut at the same part of their peak as before: each is off by
/// at most 2 `cut` times its color. Entries are bins of no raster.
///
/// Throws std::invalid_argument for a matrix that is not symmetric, positive semidefinite and finite, and for windows
/// that become wider than 512 pixels from their middle.
GaborField filtered_gabor(const GaborField& field, const Eigen::Matrix2d& covariance);

/// The same for square pixels of that side, by a Gaussian of their variance, side² / 12 along each axis. 0: no filter.
GaborField filtered_gabor(const GaborField& field, double footprint);

/// A reason why a round window cannot be filtered so: it becomes too wide.
std::optional<std::string> refuse_footprint(const GaborWindow& window, double footprint);

/// The option "footprint".
ParamSpec footprint_param();

}  // namespace textonbench
