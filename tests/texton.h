// Small textons for tests.
#pragma once

#include "methods/base/random.h"
#include "methods/base/texton.h"

namespace textonbench {

/// Kernels of white noise with a positive mean (so that centering matters) in channels that are correlated.
inline Texton test_texton(Extent extent, int channels, int kernels, std::uint64_t seed = 1) {
  Texton texton;
  for (int k = 0; k < kernels; ++k) {
    Image kernel(extent, channels);
    const Stream stream = Stream(Seed{seed}).child("texton").child(static_cast<std::uint64_t>(k));
    for (int c = 0; c < channels; ++c) {
      for (int y = 0; y < extent.height; ++y) {
        const auto row = kernel.row(c, y);
        fill_normal(stream, static_cast<std::uint64_t>(y), 0, row);
        for (float& v : row) v = 0.1F * v + 0.05F + 0.02F * static_cast<float>(c);
      }
    }
    texton.kernels.push_back(std::move(kernel));
  }
  texton.support_pixels = extent.area();
  for (int c = 0; c < channels; ++c) texton.mean.push_back(0.3 + 0.1 * c);
  return texton;
}

/// The same with one kernel and the values outside a disc set to zero.
inline Texton disc_texton(int radius, int channels) {
  Texton texton = test_texton({2 * radius + 5, 2 * radius + 3}, channels, 1);
  texton.support_pixels = 0;
  for (int y = 0; y < 2 * radius + 3; ++y) {
    for (int x = 0; x < 2 * radius + 5; ++x) {
      const bool inside = (x - radius - 2) * (x - radius - 2) + (y - radius - 1) * (y - radius - 1) <= radius * radius;
      texton.support_pixels += inside ? 1 : 0;
      for (int c = 0; c < channels && !inside; ++c) texton.kernels[0].at(c, x, y) = 0;
    }
  }
  return texton;
}

}  // namespace textonbench
