// Spectral analysis of one image.
#pragma once

#include <span>
#include <vector>

#include "methods/base/fft.h"
#include "methods/base/image.h"

namespace textonbench {

/// Mean of each channel, summed in double precision.
std::vector<double> channel_means(const Image& u);

/// Periodogram |û_c(ξ)|² / |Ω| of u minus its mean, on the half spectrum: channel c, row ky, column kx of an image of
/// (W/2 + 1) x H. Its sum over the full spectrum divided by |Ω| is the variance. Square units of u.
Image periodogram(const Image& u);

/// Periodic component of Moisan's periodic + smooth decomposition (J. Math. Imaging Vision 39, 2011), channel by
/// channel: the torus image whose Laplacian is the interior Laplacian of u, with the mean of u. May leave [0, 1]: do
/// not clamp it before an analysis. Float32; within 2e-6 of the double-precision solution for u in [0, 1].
Image periodic_component(const Image& u);

/// log10 modulus of the centred spectrum, scaled to [0, 1] for display (frequency zero in the middle; the top 5 decades
/// of power), and the phase arg û / 2π + 1/2 likewise. Same size and channels as u.
Image modulus_picture(const Image& u);
/// The same of the mean power of the periodic components of several images of one size.
Image mean_modulus_picture(std::span<const Image> images);
Image phase_picture(const Image& u);

}  // namespace textonbench
