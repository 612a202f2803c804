#include "methods/spot/extended_spot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace textonbench {
namespace {

double energy(const Image& image) {
  double sum = 0;
  for (int c = 0; c < image.channels(); ++c) {
    for (int y = 0; y < image.height(); ++y) {
      for (const float v : image.row(c, y)) {
        sum += static_cast<double>(v) * static_cast<double>(v);
      }
    }
  }
  return sum;
}

/// φ at the pixel centers of one side.
std::vector<double> window(int side, int border) {
  std::vector<double> values(static_cast<std::size_t>(side), 1.0);
  for (int x = 0; x < border; ++x) {
    const double sine = std::sin(std::numbers::pi / 2 * (x + 0.5) / border);
    values[static_cast<std::size_t>(x)] = sine * sine;
    values[static_cast<std::size_t>(side - 1 - x)] = sine * sine;
  }
  return values;
}

}  // namespace

Image equivalent_spot(const Image& spot, Extent raster, int border) {
  if (border < 0 || 2 * std::int64_t{border} > std::min(spot.width(), spot.height())) {
    throw std::invalid_argument(fmt::format("border of {} pixels on a spot of {}x{}: expected 0 to half its side",
                                            border, spot.width(), spot.height()));
  }
  Image result = extended_texton(spot, raster);
  const std::vector<double> across = window(spot.width(), border);
  const std::vector<double> down = window(spot.height(), border);
  const int left = (raster.width - spot.width()) / 2;
  const int top = (raster.height - spot.height()) / 2;
  for (int c = 0; c < spot.channels(); ++c) {
    for (int y = 0; y < spot.height(); ++y) {
      for (int x = 0; x < spot.width(); ++x) {
        float& value = result.at(c, left + x, top + y);
        value = static_cast<float>(value * across[static_cast<std::size_t>(x)] * down[static_cast<std::size_t>(y)]);
      }
    }
  }
  const double left_over = energy(result);
  const auto scale = static_cast<float>(left_over > 0 ? std::sqrt(energy(spot) / left_over) : 1.0);
  for (int c = 0; c < result.channels(); ++c) {
    for (int y = 0; y < result.height(); ++y) {
      for (float& value : result.row(c, y)) {
        value *= scale;
      }
    }
  }
  return result;
}

Image extended_texton(const Image& kernel, Extent raster) {
  if (raster.width < kernel.width() || raster.height < kernel.height()) {
    throw std::invalid_argument(fmt::format("raster of {}x{} for a spot of {}x{}: expected at least its size",
                                            raster.width, raster.height, kernel.width(), kernel.height()));
  }
  Image result(raster, kernel.channels());
  const int left = (raster.width - kernel.width()) / 2;
  const int top = (raster.height - kernel.height()) / 2;
  for (int c = 0; c < kernel.channels(); ++c) {
    for (int y = 0; y < kernel.height(); ++y) {
      std::ranges::copy(kernel.row(c, y), result.row(c, top + y).begin() + left);
    }
  }
  return result;
}

}  // namespace textonbench
