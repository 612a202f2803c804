#include "methods/spot/plane_share.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "methods/base/impact_grid.h"

namespace textonbench {
namespace {

constexpr std::int64_t furthest_corner = std::int64_t{1} << 62;
constexpr std::uint32_t bits_of_one = 0x3F800000;
constexpr std::uint32_t bits_of_infinity = 0x7F800000;

double center_of(std::int64_t corner, int size) {
  return std::ldexp(static_cast<double>(corner), -plane_bits) + (size - 1) / 2.0;
}

int kernel_of_share(double share, int kernels) { return static_cast<int>(std::lround(share * (kernels - 1))); }

int map_pixel(double coordinate, int size) {
  return static_cast<int>(std::clamp(std::floor(coordinate + 0.5), 0.0, size - 1.0));
}

/// The least v in [low, high] with is_past(v), which is monotone; `high` where there is none.
template <class Integer, class IsPast>
Integer first_past(Integer low, Integer high, const IsPast& is_past) {
  while (low < high) {
    const Integer middle = std::midpoint(low, high);
    if (is_past(middle)) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return low;
}

}  // namespace

PlaneShare::PlaneShare(Kind kind, double start, double length, Image picture)
    : kind_(kind), start_(start), length_(length), map_(std::move(picture)) {}

PlaneShare PlaneShare::uniform(double share) {
  if (!(share >= 0 && share <= 1)) {
    throw std::invalid_argument(fmt::format("share = {}: expected 0 to 1", share));
  }
  return {Kind::uniform, share, 1, {}};
}

PlaneShare PlaneShare::ramp(double start, double length) {
  if (!(std::isfinite(start) && std::isfinite(length) && length > 0)) {
    throw std::invalid_argument(fmt::format(
        "share that moves from column {} over {} pixels: expected finite numbers and a length above 0", start, length));
  }
  return {Kind::ramp, start, length, {}};
}

PlaneShare PlaneShare::map(Image picture) {
  if (picture.empty()) {
    throw std::invalid_argument("map of shares without pixels: expected at least one");
  }
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      if (const float value = picture.at(0, x, y); !(value >= 0 && value <= 1)) {
        throw std::invalid_argument(fmt::format("the share {} at ({}, {}); expected 0 to 1", value, x, y));
      }
    }
  }
  return {Kind::map, 0, 1, std::move(picture)};
}

double PlaneShare::at(double x, double y) const {
  switch (kind_) {
    case Kind::uniform:
      return start_;
    case Kind::ramp:
      return std::clamp((x - start_) / length_, 0.0, 1.0);
    case Kind::map:
      break;
  }
  return map_.at(0, map_pixel(x, map_.width()), map_pixel(y, map_.height()));
}

int PlaneShare::kernel_at(double x, double y, int kernels) const { return kernel_of_share(at(x, y), kernels); }

int kernel_with_corner(const PlaneShare& share, std::int64_t corner_x, std::int64_t corner_y, Extent box, int kernels) {
  return share.kernel_at(center_of(corner_x, box.width), center_of(corner_y, box.height), kernels);
}

std::vector<std::int64_t> ramp_borders(const PlaneShare& share, Extent box, int kernels) {
  std::vector<std::int64_t> borders;
  borders.reserve(static_cast<std::size_t>(kernels));
  for (int k = 1; k < kernels; ++k) {
    // Every operation of the kernel's number is monotone in the corner, its rounding included.
    borders.push_back(first_past(-furthest_corner, furthest_corner, [&](std::int64_t corner) {
      return kernel_with_corner(share, corner, 0, box, kernels) >= k;
    }));
  }
  return borders;
}

std::vector<std::uint32_t> share_borders(int kernels) {
  std::vector<std::uint32_t> borders;
  borders.reserve(static_cast<std::size_t>(kernels));
  for (int k = 1; k < kernels; ++k) {
    const std::uint32_t bits = first_past(0U, bits_of_one + 1, [&](std::uint32_t share) {
      return kernel_of_share(static_cast<double>(std::bit_cast<float>(share)), kernels) >= k;
    });
    borders.push_back(bits > bits_of_one ? bits_of_infinity : bits);
  }
  return borders;
}

}  // namespace textonbench
