// Texton noise of order 1 as the shader of the paper evaluates it (Galerne, Leclaire, Moisan, CGF 2017), in plain
// scalar code: each pixel visits the cells in reach, draws all their impacts anew and fetches a bilinear value for each
// impact that covers it.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "methods/base/impact_grid.h"
#include "methods/base/texton.h"

namespace textonbench {

/// RGB, one kernel, order 1.
class ScalarTextonNoise {
 public:
  ScalarTextonNoise(const SplineTexton& texton, const ImpactGrid& grid, std::uint64_t key)
      : grid_(grid),
        key_(key),
        width_(texton.coefficients.extent().width),
        height_(texton.coefficients.extent().height),
        texels_(static_cast<std::size_t>(3 * (width_ + 2) * (height_ + 2))) {
    const Image& kernel = texton.coefficients.kernels.front();
    for (int c = 0; c < 3; ++c) {
      double integral = 0;
      for (int y = 0; y < height_; ++y) {
        for (int x = 0; x < width_; ++x) {
          texels_[static_cast<std::size_t>(texel(x + 1, y + 1) + c)] = kernel.at(c, x, y);
          integral += kernel.at(c, x, y);
        }
      }
      scale_ = static_cast<float>(1 / std::sqrt(grid.intensity()));
      start_[c] = static_cast<float>(texton.coefficients.mean[static_cast<std::size_t>(c)] -
                                     scale_ * grid.mean_weight() * integral);
    }
  }

  /// Pixels of the square [0, side)², from (0, 0) on.
  Image draw(int side) const {
    Image out({side, side}, 3);
    std::vector<CellImpact> impacts;
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        float sum[3] = {};
        add_cells(static_cast<float>(x), static_cast<float>(y), impacts, sum);
        for (int c = 0; c < 3; ++c) {
          out.at(c, x, y) = start_[c] + scale_ * sum[c];
        }
      }
    }
    return out;
  }

 private:
  std::ptrdiff_t texel(int x, int y) const { return 3 * (std::ptrdiff_t{y} * (width_ + 2) + x); }

  /// Sum at (x, y), the coordinates being local to a cell as soon as an impact is compared with them.
  void add_cells(float x, float y, std::vector<CellImpact>& impacts, float* sum) const {
    const auto side = static_cast<float>(grid_.side());
    const int top = static_cast<int>(std::floor((y - static_cast<float>(height_)) / side));
    const int bottom = static_cast<int>(std::floor((y + 1) / side));
    const int left = static_cast<int>(std::floor((x - static_cast<float>(width_)) / side));
    const int right = static_cast<int>(std::floor((x + 1) / side));
    for (int cy = top; cy <= bottom; ++cy) {
      for (int cx = left; cx <= right; ++cx) {
        const float local_x = x - static_cast<float>(cx) * side;
        const float local_y = y - static_cast<float>(cy) * side;
        if (grid_.process() == ImpactProcess::paper) {
          add_paper_cell(cx, cy, local_x, local_y, side, sum);
        } else {
          impacts.clear();
          grid_.draw_cell(key_, cx, cy, impacts);
          for (const CellImpact& impact : impacts) {
            add_impact(local_x - static_cast<float>(impact.x) * 0x1p-24F * side,
                       local_y - static_cast<float>(impact.y) * 0x1p-24F * side, impact.weight, sum);
          }
        }
      }
    }
  }

  void add_paper_cell(int cx, int cy, float x, float y, float side, float* sum) const {
    std::uint32_t s = static_cast<std::uint32_t>(1024 * (cy & 1023) + (cx & 1023)) + static_cast<std::uint32_t>(key_);
    s = (s ^ 61U) ^ (s >> 16U);
    s *= 9U;
    s ^= s >> 4U;
    s *= 0x27D4EB2DU;
    s ^= s >> 15U;
    const auto next = [&s] {
      s ^= s << 13U;
      s ^= s >> 17U;
      s ^= s << 5U;
      return s;
    };
    const std::uint32_t u = next();
    for (std::int64_t rest = paper_count(grid_.cell_mean(), u, next()); rest > 0; --rest) {
      const float dx = x - static_cast<float>(next() >> 8U) * 0x1p-24F * side;
      add_impact(dx, y - static_cast<float>(next() >> 8U) * 0x1p-24F * side, 1, sum);
    }
  }

  void add_impact(float dx, float dy, float weight, float* sum) const {
    if (dx <= -1 || dx >= static_cast<float>(width_) || dy <= -1 || dy >= static_cast<float>(height_)) {
      return;
    }
    const float fx = std::floor(dx);
    const float fy = std::floor(dy);
    const float tx = dx - fx;
    const float ty = dy - fy;
    const float* above = texels_.data() + texel(static_cast<int>(fx) + 1, static_cast<int>(fy) + 1);
    const float* below = above + std::ptrdiff_t{3} * (width_ + 2);
    for (int c = 0; c < 3; ++c) {
      sum[c] += weight *
                ((1 - ty) * ((1 - tx) * above[c] + tx * above[c + 3]) + ty * ((1 - tx) * below[c] + tx * below[c + 3]));
    }
  }

  ImpactGrid grid_;
  std::uint64_t key_;
  int width_;
  int height_;
  std::vector<float> texels_;
  float scale_ = 0;
  float start_[3] = {};
};

}  // namespace textonbench
