// Gabor noise at points and on rasters.
//
// A kernel on a raster is a product of a column's and a row's part, exp(2πi f_x dx) g(dx) and exp(2πi (f_y dy + u))
// g(dy): one cosine and sine a column and a row instead of a pixel, and two multiplications and additions a pixel and
// channel. Points take the same products, in the same order.
#pragma once

#include <span>

#include "methods/base/image.h"
#include "methods/sparse/gabor_field.h"
#include "methods/sparse/wave_points.h"
#include "methods/sparse/wave_raster.h"

namespace textonbench {

/// out[c * points.size() + i] = n_c(points[i]), without a mean.
void sum_gabor(const GaborField& field, Seed seed, std::span<const WavePoint> points, std::span<float> out);

/// out += n. The bits are those of sum_gabor at the raster's points, rounded down to 2^−22 pixel.
void add_gabor(const GaborField& field, Seed seed, const WaveRaster& raster, Image& out);

}  // namespace textonbench
