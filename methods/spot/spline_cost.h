// What each route to a raster of texton noise costs a pixel.
#pragma once

#include "methods/base/texton.h"
#include "methods/method.h"

namespace textonbench {

/// Of a pixel: arithmetic operations, and an estimate of the time on one thread.
struct SplineCost {
  double operations = 0;
  double nanoseconds = 0;
};

/// `intensity`: impacts a pixel.
SplineCost cost_by_point(const SplineTexton& texton, double intensity);
SplineCost cost_by_impact(const SplineTexton& texton, double intensity, const Domain& domain);
SplineCost cost_by_convolution(const SplineTexton& texton, double intensity, const Domain& domain);

}  // namespace textonbench
