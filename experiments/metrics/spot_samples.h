// Raw spot noise from its definition, and the covariance of samples and of kernels at single lags: what statements
// about spot noise are tested with. Slow and obvious, apart from the sums that the methods use.
#pragma once

#include <vector>

#include "methods/base/image.h"
#include "methods/base/random.h"

namespace textonbench {

/// F(x) = Σ_i h(x − x_i) on a window of Z², x_i a Poisson process of `intensity` impacts a pixel, below
/// dense_intensity: neither centered nor normalized.
Image raw_spot_noise(const Image& kernel, double intensity, const Stream& stream, Extent window);

/// Calls visit(x, y) for v and not −v, |v|∞ <= reach, lag zero first.
template <class Visit>
void for_each_lag(int reach, const Visit& visit) {
  for (int y = 0; y <= reach; ++y) {
    for (int x = y == 0 ? 0 : -reach; x <= reach; ++x) visit(x, y);
  }
}

/// (1/N_v) Σ_x u_c(x + v) u_c(x) over the N_v pairs of pixels inside the image, channel by channel and for each channel
/// in the order of for_each_lag. reach < both sides. By FFT; errors near 1e-6 of the largest value.
std::vector<float> lag_products(const Image& u, int reach);

/// Σ_x h_c(x + v) h_c(x) for any lag, zero outside the kernel.
double autocorrelation(const Image& kernel, int channel, int x, int y);

}  // namespace textonbench
