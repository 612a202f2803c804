#include "methods/sparse/gabor_tile.h"

#include <cmath>

namespace textonbench {

GaborTileAxis::GaborTileAxis(double begin, double by, int first_pixel, int pixels, int room)
    : count(pixels), step(by), whole(static_cast<std::size_t>(room)), part(static_cast<std::size_t>(room)) {
  const auto coordinate = [&](int i) {
    return static_cast<std::int64_t>(std::floor((begin + by * (first_pixel + i)) * plane_pixel));
  };
  first = coordinate(0), end = coordinate(pixels - 1);
  origin = whole_pixels(first);
  start = static_cast<double>(part_of_pixel(first));
  for (int i = 0; i < room; ++i) {
    const std::int64_t at = coordinate(i);
    whole.data()[i] = static_cast<std::int32_t>(whole_pixels(at) - origin);
    part.data()[i] = part_of_pixel(at);
  }
}

GaborTileSums::GaborTileSums(int channels)
    : channels_(channels), values_(static_cast<std::size_t>(gabor_tile_height * row_stride())) {
  values_.set_zero();
}

GaborTileRoom::GaborTileRoom(int channels)
    : columns(gabor_tile_width / 16 * column_stride), rows(static_cast<std::size_t>((2 + 2 * channels) * row_stride)) {}

}  // namespace textonbench
