#include "methods/spot/spline_raster.h"

#include <algorithm>
#include <numeric>

#include "methods/base/bspline.h"
#include "methods/base/convolution.h"
#include "methods/base/parallel.h"
#include "methods/spot/spline_place.h"
#include "methods/spot/spline_tile.h"

namespace textonbench {
namespace {

/// Rows that one thread splats impacts to at a time.
constexpr int raster_band = 32;

/// Rows of tiles that one thread sums, channel after channel: a channel of a large kernel stays in the L2 cache under
/// them.
constexpr int band_tile_rows = 4;

/// An impact whose first taps are pixels (x + column, y + row) of the raster.
struct RasterImpact {
  std::int64_t x = 0;
  std::int64_t y = 0;
  int kernel = 0;
  bool negative = false;
  TapWeights weights;
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
  RasterImpact placed{-(dx >> plane_bits), -(dy >> plane_bits), impact.kernel, impact.weight < 0, {}};
  weights_of_order(order, knot_position(dx), placed.weights.x);
  weights_of_order(order, knot_position(dy), placed.weights.y);
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

/// Tiles [begin, end) of a row that an impact reaches, and its tap under the first pixel of tile 0.
struct TileSpan {
  std::int64_t begin;
  std::int64_t end;
  const float* from;
  const TapWeights* weights;
};

/// Visits tile by tile, those of a tile in the order of the spans.
struct TileVisits {
  std::vector<TileVisit> visits;
  std::vector<std::size_t> first;
};

TileVisits sort_by_tile(std::span<const TileSpan> spans, std::size_t tiles) {
  TileVisits sorted{{}, std::vector<std::size_t>(tiles + 1)};
  for (const TileSpan& span : spans) {
    for (std::int64_t tile = span.begin; tile < span.end; ++tile) {
      ++sorted.first[static_cast<std::size_t>(tile) + 1];
    }
  }
  std::partial_sum(sorted.first.begin(), sorted.first.end(), sorted.first.begin());
  sorted.visits.resize(sorted.first.back());
  std::vector<std::size_t> next = sorted.first;
  for (const TileSpan& span : spans) {
    for (std::int64_t tile = span.begin; tile < span.end; ++tile) {
      sorted.visits[next[static_cast<std::size_t>(tile)]++] = {span.from + tile * tile_width, span.weights};
    }
  }
  return sorted;
}

/// Visits of the tiles whose first row is pixel row `top`, in the first channel.
TileVisits visit_tiles(const SplineTexton& texton, std::span<const Image> framed, std::span<const RasterStrip> strips,
                       int width, int top) {
  const int order = texton.order;
  const int height = tile_height(order);
  const Extent kernel = texton.coefficients.extent();
  std::vector<TileSpan> spans;
  visit_band(
      strips, top, top + height, kernel.height + order, [&](const RasterImpact& impact, std::int64_t, std::int64_t) {
        // Columns whose first tap is a coefficient, and which one of the pixels takes.
        const std::int64_t left = impact.x + order;
        const std::int64_t right = std::min<std::int64_t>(left + kernel.width, width + order);
        if (left < right && right > 0) {
          const Image& image =
              framed[static_cast<std::size_t>(impact.kernel) + (impact.negative ? framed.size() / 2 : 0)];
          const std::int64_t row = top - impact.y + height - 1;
          spans.push_back({std::max<std::int64_t>(0, left) / tile_width, (right + tile_width - 1) / tile_width,
                           image.plane(0) + row * image.row_stride() + (tile_width - 1 - left), &impact.weights});
        }
      });
  return sort_by_tile(spans, static_cast<std::size_t>((width + order + tile_width - 1) / tile_width));
}

}  // namespace

std::vector<Image> frame_coefficients(const SplineTexton& texton, double scale, bool both_signs) {
  const int left = tile_width - 1;
  const int top = tile_height(texton.order) - 1 + texton.order;
  const auto [width, height] = texton.coefficients.extent();
  std::vector<Image> framed;
  framed.reserve(2 * texton.coefficients.kernels.size());
  for (const double factor : both_signs ? std::vector{scale, -scale} : std::vector{scale}) {
    for (const Image& kernel : texton.coefficients.kernels) {
      Image& image = framed.emplace_back(Extent{width + 2 * left, height + 2 * top}, texton.coefficients.channels());
      for (int c = 0; c < kernel.channels(); ++c) {
        for (int y = 0; y < height; ++y) {
          std::ranges::transform(kernel.row(c, y), image.row(c, y + top).begin() + left,
                                 [factor](float v) { return static_cast<float>(factor * v); });
        }
      }
    }
  }
  return framed;
}

Image sum_by_impact(const SplineTexton& texton, std::span<const Image> framed, const RasterImpacts& impacts,
                    std::span<const float> start) {
  const int height = tile_height(texton.order);
  const int tile_rows = (impacts.size.height + height - 1) / height;
  const std::ptrdiff_t stride = framed.front().row_stride();
  const std::ptrdiff_t plane = framed.front().height() * stride;
  const std::vector<RasterStrip> strips = draw_strips(texton, impacts, reach(texton));
  Image out = Image::uninitialized(impacts.size, texton.coefficients.channels());
  parallel_for((tile_rows + band_tile_rows - 1) / band_tile_rows, [&](int band) {
    const int first = band * band_tile_rows;
    const int end = std::min(first + band_tile_rows, tile_rows);
    std::vector<TileVisits> rows;
    rows.reserve(band_tile_rows);
    for (int i = first; i < end; ++i) {
      rows.push_back(visit_tiles(texton, framed, strips, impacts.size.width, i * height));
    }
    for (int c = 0; c < out.channels(); ++c) {
      for (int i = first; i < end; ++i) {
        const TileVisits& tiles = rows[static_cast<std::size_t>(i - first)];
        sum_tiles(
            texton.order, {tiles.visits, tiles.first, stride}, c * plane, start[static_cast<std::size_t>(c)],
            {out.row(c, i * height).data(), out.row_stride(), std::min(height, impacts.size.height - i * height)});
      }
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
            const float share = impact.weights.y[texton.order - (y - impact.y)];
            const float weight = impact.negative ? -share : share;
            for (std::int64_t i = std::max<std::int64_t>(0, -left); i <= texton.order && left + i < size.width; ++i) {
              row[static_cast<std::size_t>(left + i)] += weight * impact.weights.x[texton.order - i];
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
