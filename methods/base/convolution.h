// Sums of convolutions of a noise with kernels, by FFT.
#pragma once

#include <span>

#include "methods/base/fft.h"
#include "methods/base/image.h"

namespace textonbench {

/// `image` wrapped around a torus of size `grid`: pixels that are equal modulo the grid are added. Its transform is
/// that of the image on the plane, taken at the frequencies of the grid.
Image wrap(const Image& image, Extent grid);

/// Σ_k h_k * w_k on the plane, where all that it needs of the fields is there: pixel x of the result is
///
///   Σ_k Σ_j h_k(j) w_k(x + size(h) − 1 − j),
///
/// and its size is that of the fields minus that of the kernels plus 1. Fields have one channel, kernels any number,
/// and each group one size; there are as many of the one as of the other.
Image convolve_valid(std::span<const Image> kernels, std::span<const Image> fields);

/// The same on the torus of the fields' size: Σ_k Σ_j h_k(j) w_k(x − j).
Image convolve_circular(std::span<const Image> kernels, std::span<const Image> fields);

/// Adds a number to each channel.
void add_constant(std::span<const double> constant, Image& image);

/// The torus on which convolve_valid computes a window of size `window`.
Extent convolution_grid(Extent kernel, Extent window);

}  // namespace textonbench
