#include "methods/base/mask.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace textonbench {
namespace {

/// Far enough from every pixel, and from the largest integer.
constexpr int never = std::numeric_limits<int>::min() / 4;

/// Every pixel within `distance` of one in the set, in the line of pixels set(0) … set(n − 1): marks them.
template <class Contains, class Add>
void spread_along(int n, int distance, bool torus, const Contains& contains, const Add& add) {
  // Where the line is closed, a first turn meets what lies beyond its end.
  const int start = torus ? -n : 0;
  int last = never;
  for (int i = start; i < n; ++i) {
    if (contains(i < 0 ? i + n : i)) last = i;
    if (i >= 0 && i - last <= distance) add(i);
  }
  last = never;
  for (int i = start; i < n; ++i) {
    if (contains(i < 0 ? -1 - i : n - 1 - i)) last = i;
    if (i >= 0 && i - last <= distance) add(n - 1 - i);
  }
}

}  // namespace

Mask::Mask(Extent extent, bool value) : extent_(extent) {
  if (extent.width < 1 || extent.height < 1) {
    throw std::invalid_argument(
        fmt::format("mask of {}x{} pixels: expected sides of at least 1", extent.width, extent.height));
  }
  bits_.assign(static_cast<std::size_t>(extent.area()), value ? 1 : 0);
}

std::int64_t Mask::count() const { return std::count(bits_.begin(), bits_.end(), std::uint8_t{1}); }

Mask dilate(const Mask& mask, int distance, bool torus) {
  if (distance < 0) throw std::invalid_argument(fmt::format("dilate: distance {}, expected at least 0", distance));
  const auto [width, height] = mask.extent();
  // Beyond the longer side nothing is new, and sums with a larger number might overflow.
  const int reach = std::min(distance, std::max(width, height));
  Mask across(mask.extent());
  for (int y = 0; y < height; ++y) {
    spread_along(
        width, reach, torus, [&, y](int x) { return mask.at(x, y); }, [&, y](int x) { across.set(x, y, true); });
  }
  Mask result(mask.extent());
  for (int x = 0; x < width; ++x) {
    spread_along(
        height, reach, torus, [&, x](int y) { return across.at(x, y); }, [&, x](int y) { result.set(x, y, true); });
  }
  return result;
}

Mask difference(const Mask& a, const Mask& b) {
  if (a.extent() != b.extent()) {
    throw std::invalid_argument(fmt::format("difference of masks of {}x{} and {}x{} pixels: expected one size",
                                            a.extent().width, a.extent().height, b.extent().width, b.extent().height));
  }
  Mask result(a.extent());
  for (int y = 0; y < a.extent().height; ++y) {
    for (int x = 0; x < a.extent().width; ++x) result.set(x, y, a.at(x, y) && !b.at(x, y));
  }
  return result;
}

std::vector<Pixel> pixels_of(const Mask& mask) {
  std::vector<Pixel> pixels;
  pixels.reserve(static_cast<std::size_t>(mask.count()));
  for (int y = 0; y < mask.extent().height; ++y) {
    for (int x = 0; x < mask.extent().width; ++x) {
      if (mask.at(x, y)) pixels.push_back({x, y});
    }
  }
  return pixels;
}

Rectangle bounding_box(std::span<const Pixel> pixels) {
  if (pixels.empty()) throw std::invalid_argument("bounding_box: expected at least one pixel");
  const auto [left, right] = std::ranges::minmax(pixels, {}, &Pixel::x);
  const auto [top, bottom] = std::ranges::minmax(pixels, {}, &Pixel::y);
  return {left.x, top.y, {right.x - left.x + 1, bottom.y - top.y + 1}};
}

}  // namespace textonbench
