// Local random-phase noise on a raster, by separable products.
//
// On a raster a wave is a product: with z = a exp(2πi (k_x x / T + …)) of a column and β = 2π k_y y / T of a row,
//
//   Re(z exp(±iβ)) = Re z cos β ∓ Im z sin β,
//
// so that the waves of a cell are two matrix products of columns x waves x rows, and two rows as far above as below any
// middle share both. That leaves one multiplication and addition for each pixel, wave and channel. Bins are whole, so
// exp(2πi k_x x / T) of all columns of a tile, from its first one, is a table of few rows, and so is β: a wave takes
// one cosine and sine a cell.
#pragma once

#include "methods/base/image.h"
#include "methods/sparse/wave_field.h"

namespace textonbench {

/// Pixel (i, j) is at (x + i step, y + j step) pixels of the plane, rounded down to 2^−22.
struct WaveRaster {
  double x = 0;
  double y = 0;
  double step = 1;
};

/// out += n, without the mean; within 1e-5 standard deviations of sum_waves(). Rasters whose corners are whole steps
/// from the origin, which the rounding above leaves whole (steps that are multiples of 2^−22), agree bit for bit where
/// they overlap.
void add_waves(const WaveField& field, Seed seed, const WaveRaster& raster, Image& out);

}  // namespace textonbench
