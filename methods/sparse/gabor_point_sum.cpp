#include "methods/sparse/gabor_point_sum.h"

#include <algorithm>
#include <cmath>

namespace textonbench {
namespace {

/// keep[i] = −1 where the window of the impact at (x[i], y[i]) may reach into a box, else 0: whole vectors.
__attribute__((target_clones("default", "avx2", "avx512f"))) void find_near(const GaborShape& shape,
                                                                            const PixelBox& box, const float* x,
                                                                            const float* y, int count,
                                                                            std::int32_t* keep) {
  // Places are rounded to 2^−24 of the distance from their origin.
  const float margin = 1e-3F;
  const float half_u = shape.along * (box.half_width + margin) + std::abs(shape.shear) * (box.half_height + margin);
  const float half_v = shape.across * (box.half_height + margin);
  const float along = shape.along, shear = shape.shear, across = shape.across, limit = shape.limit * 1.00001F;
  const float middle_x = box.x, middle_y = box.y;
  for (int i = 0; i < count; ++i) {
    const float dx = x[i] - middle_x, dy = y[i] - middle_y;
    const float u = std::max(std::abs(along * dx + shear * dy) - half_u, 0.0F);
    const float v = std::max(std::abs(across * dy) - half_v, 0.0F);
    keep[i] = u * u + v * v < limit ? -1 : 0;
  }
}

}  // namespace

void choose_impacts(const GaborShape& shape, const PixelBox& box, const ImpactChoice& impacts, ImpactChoice& chosen) {
  chosen.resize(static_cast<std::size_t>(impacts.count));
  if (chosen.near.size() < impacts.x.size()) chosen.near.resize(impacts.x.size());
  std::int32_t* keep = chosen.near.data();
  find_near(shape, box, impacts.x.data(), impacts.y.data(), impacts.count, keep);
  const float *x = impacts.x.data(), *y = impacts.y.data();
  const std::uint32_t* number = impacts.number.data();
  float *to_x = chosen.x.data(), *to_y = chosen.y.data();
  std::uint32_t* to_number = chosen.number.data();
  int count = 0;
  for (int i = 0; i < impacts.count; ++i) {
    to_x[count] = x[i], to_y[count] = y[i], to_number[count] = number[i];
    count -= keep[i];
  }
  chosen.count = count;
}

}  // namespace textonbench
