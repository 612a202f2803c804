// Sums of spline kernels on rasters of step 1, where the position of an impact between the pixels is the same for all
// of them: by impact, or by FFT convolution of the coefficients with the impacts' splines. Two routes to one image.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "methods/base/impact_grid.h"
#include "methods/base/texton.h"
#include "methods/spot/spline_points.h"

namespace textonbench {

/// Coefficients times `scale` with a frame of zeros, for sums made tile by tile; where there are impacts of both signs,
/// the kernels of the negative ones after the others, times −scale.
std::vector<Image> frame_coefficients(const SplineTexton& texton, double scale, bool both_signs);

/// Impacts of a raster.
struct RasterImpacts {
  const ImpactGrid& grid;
  std::uint64_t key;
  PlanePoint origin;  ///< of pixel (0, 0)
  Extent size;
};

/// start_c + scale Σ_i w_i h_{k_i, c}(y − x_i) at the pixels y, the scale being in the framed coefficients. Pixels that
/// two rasters share, of origins a whole number of pixels apart, have the same bits.
Image sum_by_impact(const SplineTexton& texton, std::span<const Image> framed, const RasterImpacts& impacts,
                    std::span<const float> start);

/// mean_c + scale (Σ_i w_i h_{k_i, c}(y − x_i) − its expectation): the same to 1e-5 of its standard deviation, at a
/// cost that hardly depends on the number of impacts.
Image sum_by_convolution(const SplineTexton& texton, double scale, const RasterImpacts& impacts,
                         std::span<const double> mean);

}  // namespace textonbench
