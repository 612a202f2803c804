// Filters of a bilinear kernel h(x) = Σ_j α(j) β^1(x1 − j1) β^1(x2 − j2) by the footprint of a pixel on the plane.
//
// A filtered noise is the noise of the filtered kernel (Galerne, Leclaire, Moisan, CGF 2017, Section 5). All filters
// here have unit gain, ∫ filtered h = ∫ h, so a filtered noise is centered by the same constant. They approximate the
// average of h over the parallelogram that the columns of the footprint span.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "methods/base/image.h"

namespace textonbench {

/// Channels of a texel; zero beyond those of the kernel.
using Texel = Eigen::Vector4f;

/// How a kernel is read at a point: as it is; from the level of the mip chain that the longer side of the footprint
/// asks for; by several such probes along that side; or by an elliptic Gaussian sum over the coefficients.
enum class TextonFilter { none, trilinear, anisotropic, ewa };

/// α (level 0) and its averages over squares of 2^l coefficients that start at multiples of 2^l from the first one, up
/// to the level L of a single texel. Every level has a frame of one texel of zeros, which is what a frame of 2^L zeros
/// around α becomes at level L: no texel mixes opposite borders, and none is cut.
class MipChain {
 public:
  static constexpr int max_channels = Texel::SizeAtCompileTime;

  /// Throws std::invalid_argument for coefficients of more than max_channels channels.
  explicit MipChain(const Image& coefficients);

  /// L.
  int coarsest() const { return static_cast<int>(levels_.size()) - 1; }
  /// Texels of a level, its frame left out.
  Extent extent(int level) const { return levels_[static_cast<std::size_t>(level)].extent; }
  /// x in [−1, width], y in [−1, height].
  const Texel& texel(int level, int x, int y) const { return levels_[static_cast<std::size_t>(level)].at(x, y); }
  /// α(x, y), zero outside.
  Texel coefficient(int x, int y) const;

  /// Between the four texels of a level around (x, y), in coefficients; zero outside. Level 0 is h.
  Texel bilinear(int level, double x, double y) const;
  /// Between the two levels around `level`, in [0, L].
  Texel trilinear(double level, double x, double y) const;

  std::size_t bytes() const;

 private:
  struct Level {
    explicit Level(Extent size);
    std::size_t stride() const { return static_cast<std::size_t>(extent.width) + 2; }
    const Texel& at(int x, int y) const {
      return texels[static_cast<std::size_t>(y + 1) * stride() + static_cast<std::size_t>(x + 1)];
    }
    void set(int x, int y, const Texel& value) {
      texels[static_cast<std::size_t>(y + 1) * stride() + static_cast<std::size_t>(x + 1)] = value;
    }

    Extent extent;
    std::vector<Texel> texels;
  };
  std::vector<Level> levels_;
};

/// A filter under one footprint. The columns of the footprint are what one pixel to the right and one pixel down are on
/// the plane; P and p are their lengths, the longer first.
///
///   trilinear    one probe of level log2 P
///   anisotropic  the mean of N = min(⌈P/p⌉, 16) probes of level log2(P/N) at i/(N + 1) − 1/2 of the longer column,
///                i = 1 … N, as EXT_texture_filter_anisotropic describes it
///   ewa          Σ_j α(j) w(x − j) / Σ_j w(x − j) with w(δ) = exp(−q/2), q = δᵀ V⁻¹ δ <= 9 (Heckbert 1989), where
///                V = J Jᵀ/12 + I/6 adds the covariance of a pixel's square to that of β^1: so as the footprint J
///                shrinks the filter becomes a Gaussian of the variance of β^1, not β^1 itself
///
/// Levels are held within [0, L].
class KernelFilter {
 public:
  /// Throws std::invalid_argument for a footprint that is not finite or is singular.
  KernelFilter(TextonFilter filter, const Eigen::Matrix2d& footprint, int coarsest);

  /// The filtered kernel is zero farther than this beyond [−1/2, W − 1/2] x [−1/2, H − 1/2].
  const Eigen::Vector2d& margin() const { return margin_; }
  /// Mean number of texels that a point reads.
  double texels() const;

  /// At (x, y) from the kernel's first coefficient, in coefficients.
  Texel operator()(const MipChain& kernel, double x, double y) const;

 private:
  void prepare_probes(const Eigen::Matrix2d& footprint, int most, int coarsest);
  void prepare_ellipse(const Eigen::Matrix2d& footprint);
  Texel elliptic_sum(const MipChain& kernel, double x, double y) const;

  TextonFilter filter_;
  Eigen::Vector2d margin_{0.5, 0.5};
  int probes_ = 1;
  double level_ = 0;
  Eigen::Vector2d axis_{0, 0};                       // the longer column
  Eigen::Matrix2d conic_ = Eigen::Matrix2d::Zero();  // V⁻¹
  Eigen::Vector2d half_box_{0, 0};                   // of the ellipse
};

}  // namespace textonbench
