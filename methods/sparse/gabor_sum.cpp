#include "methods/sparse/gabor_sum.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "methods/base/parallel.h"
#include "methods/sparse/gabor_kernel.h"
#include "methods/sparse/gabor_tile.h"

namespace textonbench {
namespace {

/// Steps beyond this are summed point by point: kernels of few pixels gain little from their columns and rows.
constexpr double widest_raster_step = 8;

void add_far_apart(const GaborField& field, Seed seed, const WaveRaster& raster, Image& out) {
  std::vector<WavePoint> points;
  points.reserve(out.extent().area());
  for (int y = 0; y < out.height(); ++y) {
    for (int x = 0; x < out.width(); ++x) {
      points.push_back({static_cast<std::int64_t>(std::floor((raster.x + raster.step * x) * plane_pixel)),
                        static_cast<std::int64_t>(std::floor((raster.y + raster.step * y) * plane_pixel))});
    }
  }
  std::vector<float> values(points.size() * static_cast<std::size_t>(out.channels()));
  sum_gabor(field, seed, points, values);
  const float* from = values.data();
  for (int c = 0; c < out.channels(); ++c) {
    for (int y = 0; y < out.height(); ++y) {
      for (float& v : out.row(c, y)) v += *from++;
    }
  }
}

}  // namespace

void add_gabor(const GaborField& field, Seed seed, const WaveRaster& raster, Image& out) {
  if (raster.step > widest_raster_step) {
    add_far_apart(field, seed, raster, out);
    return;
  }
  std::vector<GaborShape> shapes;
  shapes.reserve(field.bands.size());
  for (const GaborBand& band : field.bands) shapes.emplace_back(field, band);
  const int across = (out.width() + gabor_tile_width - 1) / gabor_tile_width;
  const int down = (out.height() + gabor_tile_height - 1) / gabor_tile_height;
  parallel_for(across * down, [&](int tile) {
    const int left = tile % across * gabor_tile_width, top = tile / across * gabor_tile_height;
    const GaborTileAxis x(raster.x, raster.step, left, std::min(gabor_tile_width, out.width() - left),
                          gabor_tile_width);
    const GaborTileAxis y(raster.y, raster.step, top, std::min(gabor_tile_height, out.height() - top),
                          gabor_tile_height);
    const GaborTileSums sums(field.channels);
    GaborTileRoom room(field.channels);
    std::vector<GaborImpact> drawn;
    std::vector<NearImpact> impacts;
    for (std::size_t b = 0; b < field.bands.size(); ++b) {
      const GaborShape& shape = shapes[b];
      drawn.clear(), impacts.clear();
      GaborImpacts(field, b, seed)
          .draw(
              {x.first - shape.reach_x, y.first - shape.reach_y, x.end + shape.reach_x + 1, y.end + shape.reach_y + 1},
              drawn);
      impacts.reserve(drawn.size());
      for (const GaborImpact& impact : drawn) impacts.push_back(near_impact(impact, x.origin, y.origin));
      add_to_tile(shape, impacts, x, y, room, sums);
    }
    for (int c = 0; c < field.channels; ++c) {
      for (int j = 0; j < y.count; ++j) {
        float* to = out.row(c, top + j).data() + left;
        const float* from = sums.row(c, j);
        for (int i = 0; i < x.count; ++i) to[i] += from[i];
      }
    }
  });
}

}  // namespace textonbench
