// Texton noise of the plane whose kernel is filtered by the footprint of each point: the field of spline_noise.h, to
// the last impact, seen through a filter of texton_filter.h.
#pragma once

#include <cstdint>
#include <vector>

#include "methods/method.h"
#include "methods/spot/spline_noise.h"
#include "methods/spot/texton_filter.h"

namespace textonbench {

/// The impacts that a point visits: all that its filtered kernel reaches, or those that the unfiltered one reaches, as
/// where a shader skips texture coordinates outside [0, 1]. The latter cuts the filtered kernel to the box of h.
enum class ImpactWindow { footprint, kernel };

class FilteredSum {
 public:
  /// Throws std::invalid_argument as make_spline_noise does, for another order than 1 and for more than 4 channels.
  FilteredSum(SplineTexton texton, const SplineNoiseOptions& options);

  /// All channels of the noise at a point within 2^40 pixels of the origin. `impacts` is scratch. Throws
  /// std::invalid_argument for a point farther away and a footprint that KernelFilter refuses.
  Eigen::Vector4d evaluate(const Eigen::Vector2d& point, const Eigen::Matrix2d& footprint, TextonFilter filter,
                           ImpactWindow window, std::uint64_t key, std::vector<PlaneImpact>& impacts) const;

  /// Additions and multiplications of texels that such a point takes on average, all channels together.
  double operations(const Eigen::Matrix2d& footprint, TextonFilter filter, ImpactWindow window) const;

  const SplineTexton& texton() const { return texton_; }
  /// Of the mip chains.
  std::size_t bytes() const;

 private:
  SplineTexton texton_;
  ImpactGrid grid_;
  double scale_;
  std::vector<MipChain> chains_;
  Eigen::Vector4d start_;  // m − λ ∫h, scaled
};

}  // namespace textonbench
