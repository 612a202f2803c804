// Texton noises for the tests of their shaders.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "gpu/context.h"
#include "gpu/renderer.h"
#include "methods/base/bspline.h"
#include "methods/spot/spline_noise.h"
#include "tests/texton.h"

namespace textonbench {

/// 9 x 7 coefficients a kernel.
inline SplineTexton shader_texton(int order, int channels, int kernels) {
  SplineTexton texton{.coefficients = test_texton({9, 7}, channels, kernels), .order = order};
  texton.support_area = (9 + order) * (7 + order);
  return texton;
}

/// Standard deviation of each channel: (Σ_k ∫ h_k²)^(1/2), where ∫ h² = Σ_v (α * α~)(v) b(v1) b(v2).
inline std::vector<double> deviations(const SplineTexton& texton) {
  const auto b = bspline_autocorrelation(texton.order);
  const auto [width, height] = texton.coefficients.extent();
  std::vector<double> deviations;
  for (int c = 0; c < texton.coefficients.channels(); ++c) {
    double variance = 0;
    for (const Image& kernel : texton.coefficients.kernels) {
      for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
          for (int j = std::max(0, y - texton.order); j <= std::min(height - 1, y + texton.order); ++j) {
            for (int i = std::max(0, x - texton.order); i <= std::min(width - 1, x + texton.order); ++i) {
              variance += static_cast<double>(kernel.at(c, x, y)) * static_cast<double>(kernel.at(c, i, j)) *
                          b[static_cast<std::size_t>(std::abs(i - x))] * b[static_cast<std::size_t>(std::abs(j - y))];
            }
          }
        }
      }
    }
    deviations.push_back(std::sqrt(variance));
  }
  return deviations;
}

/// The context of that kind, or of the first that can be made; null with the reason where there is none.
inline std::unique_ptr<Context> test_context(ContextKind kind, std::string& reason) {
  try {
    return make_context(kind);
  } catch (const GpuError& error) {
    reason = error.what();
    return nullptr;
  }
}

/// Largest difference over all pixels of a channel, in its standard deviations.
inline double largest_difference(const Image& a, const Image& b, const std::vector<double>& deviations) {
  double largest = 0;
  for (int c = 0; c < a.channels(); ++c) {
    for (int y = 0; y < a.height(); ++y) {
      for (int x = 0; x < a.width(); ++x) {
        const double difference = std::abs(static_cast<double>(a.at(c, x, y)) - static_cast<double>(b.at(c, x, y)));
        // A value that is no number is as wrong as can be.
        if (!(difference / deviations[static_cast<std::size_t>(c)] <= largest)) {
          largest = std::isfinite(difference) ? difference / deviations[static_cast<std::size_t>(c)] : 1e30;
        }
      }
    }
  }
  return largest;
}

}  // namespace textonbench
