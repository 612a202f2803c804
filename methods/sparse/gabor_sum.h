// Gabor noise at points and on rasters.
//
// A kernel on a raster is a product of a column's and a row's part, exp(2πi f_x dx) g(dx) and exp(2πi (f_y dy + u))
// g(dy), with a window at each pixel where it is skewed: one cosine and sine a column and a row instead of a pixel, and
// two fused multiply-adds a pixel and channel. Points take one cosine and sine each, which costs them less than the
// products would: the two routes differ by rounding, and cut kernels at the same places.
#pragma once

#include <span>

#include "methods/base/image.h"
#include "methods/sparse/gabor_field.h"
#include "methods/sparse/wave_points.h"
#include "methods/sparse/wave_raster.h"

namespace textonbench {

/// out[c * points.size() + i] = n_c(points[i]), without a mean. A point's bits do not depend on the others of a call;
/// points that are near each other are fastest, in any order, since they share the impacts that are drawn.
void sum_gabor(const GaborField& field, Seed seed, std::span<const WavePoint> points, std::span<float> out);

/// out += n, at points that are rounded down to 2^−22 pixel; within 1e-5 standard deviations of sum_gabor there. The
/// bits of rasters that have points in common, of the same step, are the same there.
void add_gabor(const GaborField& field, Seed seed, const WaveRaster& raster, Image& out);

}  // namespace textonbench
