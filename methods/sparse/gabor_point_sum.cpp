#include "methods/sparse/gabor_point_sum.h"

#include <algorithm>
#include <cmath>

#include "methods/sparse/wave_lanes.h"

namespace textonbench {
namespace {

/// keep[i] = −1 where the window of the impact at (x[i], y[i]) may reach into a box, else 0: whole vectors.
__attribute__((target_clones("default", "avx2", "avx512f"))) void find_near(const GaborShape& shape,
                                                                            const PixelBox& box, const float* x,
                                                                            const float* y, std::int32_t* keep) {
  using Floats = SixteenLanes::Floats;
  // Places are rounded to 2^−24 of the distance from their origin.
  const float margin = 1e-3F;
  const float half_u = shape.along * (box.half_width + margin) + std::abs(shape.shear) * (box.half_height + margin);
  const float half_v = shape.across * (box.half_height + margin);
  const Floats dx = *reinterpret_cast<const SixteenLanes::LooseFloats*>(x) - box.x;
  const Floats dy = *reinterpret_cast<const SixteenLanes::LooseFloats*>(y) - box.y;
  Floats u = shape.along * dx + shape.shear * dy, v = shape.across * dy;
  u = (u < 0 ? -u : u) - half_u, v = (v < 0 ? -v : v) - half_v;
  u = u > 0 ? u : Floats{}, v = v > 0 ? v : Floats{};
  *reinterpret_cast<SixteenLanes::Ints*>(keep) = u * u + v * v < shape.limit * 1.00001F;
}

}  // namespace

void choose_impacts(const GaborShape& shape, const PixelBox& box, const ImpactChoice& impacts, ImpactChoice& chosen) {
  chosen.resize(static_cast<std::size_t>(impacts.count));
  int count = 0;
  for (int first = 0; first < impacts.count; first += SixteenLanes::count) {
    alignas(64) std::int32_t keep[SixteenLanes::count];
    find_near(shape, box, impacts.x.data() + first, impacts.y.data() + first, keep);
    const int some = std::min(SixteenLanes::count, impacts.count - first);
    for (int i = 0; i < some; ++i) {
      const auto from = static_cast<std::size_t>(first + i), to = static_cast<std::size_t>(count);
      chosen.x[to] = impacts.x[from], chosen.y[to] = impacts.y[from], chosen.number[to] = impacts.number[from];
      count -= keep[i];
    }
  }
  chosen.count = count;
}

}  // namespace textonbench
