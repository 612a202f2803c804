#include "methods/spot/spline_raster.h"

#include <algorithm>

#include "methods/base/bspline.h"
#include "methods/base/convolution.h"
#include "methods/base/parallel.h"
#include "methods/spot/spline_place.h"

namespace textonbench {
namespace {

/// Rows that one thread sums at a time: with the width of a texton they stay in the L1 cache.
constexpr int raster_band = 32;

/// Floats of a cache line.
constexpr int raster_line = 16;
using RasterLine = float __attribute__((vector_size(raster_line * sizeof(float)), may_alias));
using KernelLine = float __attribute__((vector_size(raster_line * sizeof(float)), aligned(alignof(float)), may_alias));

/// An impact whose first taps are pixels (x + column, y + row) of the raster.
struct RasterImpact {
  std::int64_t x = 0;
  std::int64_t y = 0;
  int kernel = 0;
  float wx[max_bspline_order + 1] = {};
  float wy[max_bspline_order + 1] = {};
};

/// Impacts of one row of cells, and the rows [first, end) of the raster that they reach.
struct RasterStrip {
  std::int64_t first = 0;
  std::int64_t end = 0;
  std::vector<RasterImpact> impacts;
};

void weights_of_order(int order, float t, float* weights) {
  switch (order) {
    case 0:
      return spline_weights<0>(t, weights);
    case 1:
      return spline_weights<1>(t, weights);
    case 2:
      return spline_weights<2>(t, weights);
    case 3:
      return spline_weights<3>(t, weights);
    case 4:
      return spline_weights<4>(t, weights);
    default:
      return spline_weights<5>(t, weights);
  }
}

/// With d = pixel − impact, the first tap of pixel X is X − x: x = −floor((d(0) + tap_offset) / plane_unit).
RasterImpact place_impact(int order, PlanePoint origin, const PlaneImpact& impact) {
  const std::int64_t dx = origin.x + tap_offset(order) - impact.x;
  const std::int64_t dy = origin.y + tap_offset(order) - impact.y;
  RasterImpact placed{-(dx >> plane_bits), -(dy >> plane_bits), impact.kernel, {}, {}};
  weights_of_order(order, knot_position(dx), placed.wx);
  weights_of_order(order, knot_position(dy), placed.wy);
  for (float& w : placed.wx) {
    w *= impact.weight;
  }
  return placed;
}

std::vector<RasterStrip> draw_strips(const SplineTexton& texton, const RasterImpacts& raster, Extent reach) {
  const PlaneRectangle pixels{raster.origin.x, raster.origin.y, raster.origin.x + (raster.size.width - 1) * plane_unit,
                              raster.origin.y + (raster.size.height - 1) * plane_unit};
  const auto rows = raster.grid.cell_rows(reaching(texton.order, reach, pixels));
  std::vector<RasterStrip> strips(rows.size());
  parallel_for(static_cast<int>(rows.size()), [&](int i) {
    std::vector<PlaneImpact> drawn;
    raster.grid.draw(raster.key, rows[static_cast<std::size_t>(i)], drawn);
    RasterStrip& strip = strips[static_cast<std::size_t>(i)];
    strip.impacts.reserve(drawn.size());
    for (const PlaneImpact& impact : drawn) {
      const RasterImpact& placed = strip.impacts.emplace_back(place_impact(texton.order, raster.origin, impact));
      strip.first = strip.impacts.size() == 1 ? placed.y : std::min(strip.first, placed.y);
      strip.end = std::max(strip.end, placed.y + reach.height);
    }
  });
  return strips;
}

/// Calls sum(impact, first, end) for the rows [first, end) of the band that an impact reaches, in the impacts' order.
template <class Sum>
void visit_band(std::span<const RasterStrip> strips, std::int64_t top, std::int64_t bottom, int reach_height,
                const Sum& sum) {
  for (const RasterStrip& strip : strips) {
    if (strip.first >= bottom || strip.end <= top) {
      continue;
    }
    for (const RasterImpact& impact : strip.impacts) {
      const std::int64_t first = std::max(top, impact.y);
      const std::int64_t end = std::min(bottom, impact.y + reach_height);
      if (first < end) {
        sum(impact, first, end);
      }
    }
  }
}

/// Rows of a framed kernel from the first tap of the first output row on, and of the output.
struct LineRows {
  const float* from;
  std::ptrdiff_t from_stride;
  float* to;
  std::ptrdiff_t to_stride;
  std::int64_t count;
};

/// to(x, y) += Σ_j wy_j Σ_i wx_i from(x + i, y + j) in one line: rows are blended along x once and kept while the
/// output rows that they are taps of pass by.
template <int order>
[[gnu::always_inline]] inline void add_line(const LineRows& rows, const float* wx, const float* wy) {
  RasterLine blends[order + 1];
  const float* from = rows.from;
  for (int j = 0; j < order; ++j) {
    blends[j] = wx[0] * *reinterpret_cast<const KernelLine*>(from);
    for (int i = 1; i <= order; ++i) {
      blends[j] += wx[i] * *reinterpret_cast<const KernelLine*>(from + i);
    }
    from += rows.from_stride;
  }
  float* to = rows.to;
  for (std::int64_t y = 0; y < rows.count; ++y) {
    blends[order] = wx[0] * *reinterpret_cast<const KernelLine*>(from);
    for (int i = 1; i <= order; ++i) {
      blends[order] += wx[i] * *reinterpret_cast<const KernelLine*>(from + i);
    }
    RasterLine sum = wy[0] * blends[0];
    for (int j = 1; j <= order; ++j) {
      sum += wy[j] * blends[j];
    }
    *reinterpret_cast<RasterLine*>(to) += sum;
    for (int j = 0; j < order; ++j) {
      blends[j] = blends[j + 1];
    }
    from += rows.from_stride;
    to += rows.to_stride;
  }
}

/// add_line in each of `lines` lines.
template <int order>
[[gnu::always_inline]] inline void add_lines(LineRows rows, std::int64_t lines, const float* wx, const float* wy) {
  for (std::int64_t i = 0; i < lines; ++i) {
    add_line<order>(rows, wx, wy);
    rows.from += raster_line;
    rows.to += raster_line;
  }
}

__attribute__((target_clones("default", "avx2", "avx512f"))) void add_kernel(int order, const LineRows& rows,
                                                                             std::int64_t lines, const float* wx,
                                                                             const float* wy) {
  switch (order) {
    case 0:
      return add_lines<0>(rows, lines, wx, wy);
    case 1:
      return add_lines<1>(rows, lines, wx, wy);
    case 2:
      return add_lines<2>(rows, lines, wx, wy);
    case 3:
      return add_lines<3>(rows, lines, wx, wy);
    case 4:
      return add_lines<4>(rows, lines, wx, wy);
    default:
      return add_lines<5>(rows, lines, wx, wy);
  }
}

}  // namespace

std::vector<Image> frame_coefficients(const SplineTexton& texton, double scale) {
  const int left = raster_line + texton.order;
  const auto [width, height] = texton.coefficients.extent();
  std::vector<Image> framed;
  framed.reserve(texton.coefficients.kernels.size());
  for (const Image& kernel : texton.coefficients.kernels) {
    Image& image =
        framed.emplace_back(Extent{width + 2 * left, height + 2 * texton.order}, texton.coefficients.channels());
    for (int c = 0; c < kernel.channels(); ++c) {
      for (int y = 0; y < height; ++y) {
        std::ranges::transform(kernel.row(c, y), image.row(c, y + texton.order).begin() + left,
                               [scale](float v) { return static_cast<float>(scale * v); });
      }
    }
  }
  return framed;
}

Image sum_by_impact(const SplineTexton& texton, std::span<const Image> framed, const RasterImpacts& impacts,
                    std::span<const float> start) {
  const Extent kernel = reach(texton);
  const std::vector<RasterStrip> strips = draw_strips(texton, impacts, kernel);
  Image out = Image::uninitialized(impacts.size, texton.coefficients.channels());
  const std::int64_t stride = out.row_stride();
  parallel_for((impacts.size.height + raster_band - 1) / raster_band, [&](int band) {
    const int top = band * raster_band;
    const int bottom = std::min(top + raster_band, impacts.size.height);
    for (int c = 0; c < out.channels(); ++c) {
      for (int y = top; y < bottom; ++y) {
        std::fill_n(out.row(c, y).data(), stride, start[static_cast<std::size_t>(c)]);
      }
      visit_band(strips, top, bottom, kernel.height, [&](const RasterImpact& impact, std::int64_t y, std::int64_t end) {
        const Image& image = framed[static_cast<std::size_t>(impact.kernel)];
        // Whole lines of the output, from the one with the first pixel in reach to the one with the last.
        const std::int64_t left = std::max<std::int64_t>(0, impact.x) / raster_line * raster_line;
        const std::int64_t right = std::min(stride, impact.x + kernel.width);
        if (left < right) {
          const float* from = image.row(c, static_cast<int>(y - impact.y)).data() + raster_line + (left - impact.x);
          float* to = out.row(c, static_cast<int>(y)).data() + left;
          add_kernel(texton.order, {from, image.row_stride(), to, stride, end - y},
                     (right - left + raster_line - 1) / raster_line, impact.wx, impact.wy);
        }
      });
    }
  });
  return out;
}

Image sum_by_convolution(const SplineTexton& texton, double scale, const RasterImpacts& impacts,
                         std::span<const double> mean) {
  const int width = texton.coefficients.extent().width;
  const int height = texton.coefficients.extent().height;
  const std::size_t kernels = texton.coefficients.kernels.size();
  // Pixel z of a field is Σ_i w_i β(z − (width, height) + 1 − x_i): kernels reach a pixel from up to their extent away.
  const Extent size{impacts.size.width + width - 1, impacts.size.height + height - 1};
  const std::vector<RasterStrip> strips = draw_strips(texton, impacts, reach(texton));
  const double expected = impacts.grid.mean_weight() / static_cast<double>(kernels);
  std::vector<Image> fields(kernels, Image(size, 1));
  parallel_for((size.height + raster_band - 1) / raster_band, [&](int band) {
    // Rows of the raster; the spline of an impact has the first taps 0 … order of a kernel of one coefficient.
    const int top = band * raster_band - (height - 1);
    const int bottom = std::min(top + raster_band, impacts.size.height);
    visit_band(
        strips, top, bottom, texton.order + 1, [&](const RasterImpact& impact, std::int64_t y, std::int64_t end) {
          Image& field = fields[static_cast<std::size_t>(impact.kernel)];
          const std::int64_t left = impact.x + width - 1;
          for (; y < end; ++y) {
            const auto row = field.row(0, static_cast<int>(y + height - 1));
            const float weight = impact.wy[texton.order - (y - impact.y)];
            for (std::int64_t i = std::max<std::int64_t>(0, -left); i <= texton.order && left + i < size.width; ++i) {
              row[static_cast<std::size_t>(left + i)] += weight * impact.wx[texton.order - i];
            }
          }
        });
    for (Image& field : fields) {
      for (int y = top + height - 1; y < bottom + height - 1; ++y) {
        for (float& v : field.row(0, y)) {
          v = static_cast<float>(scale * (v - expected));
        }
      }
    }
  });
  Image out = convolve_valid(texton.coefficients.kernels, fields);
  add_constant(mean, out);
  return out;
}

}  // namespace textonbench
