// The inner loops of sum_gabor: a band's impacts at sixteen points.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "methods/sparse/gabor_kernel.h"

namespace textonbench {

/// Points of a vector, in pixels from some origin. Places behind the last point hold any others.
struct GaborPoints {
  static constexpr int most = 16;
  alignas(64) std::int32_t x[most];
  alignas(64) std::int32_t y[most];
  alignas(64) float part_x[most];
  alignas(64) float part_y[most];
};

/// Impacts of which some are needed: where they are, in pixels, and their numbers. With room for one more.
struct ImpactChoice {
  int count = 0;
  std::vector<float> x, y;
  std::vector<std::uint32_t> number;
  std::vector<std::int32_t> near;  ///< what choose_impacts needs

  void resize(std::size_t size) {
    if (x.size() <= size) x.resize(size + 1), y.resize(size + 1), number.resize(size + 1);
    count = static_cast<int>(size);
  }
};

/// A rectangle by its middle and half its sides, pixels.
struct PixelBox {
  float x = 0, y = 0;
  float half_width = 0, half_height = 0;
};

/// Those of `impacts`, in their order, whose windows may reach into a box.
void choose_impacts(const GaborShape& shape, const PixelBox& box, const ImpactChoice& impacts, ImpactChoice& chosen);

/// sums[c * most + i] += the chosen kernels at point i. Weights are those of the impacts times the cut.
void add_impacts(const GaborShape& shape, const GaborPoints& points, std::span<const NearImpact> impacts,
                 const ImpactChoice& chosen, float* sums);

}  // namespace textonbench
