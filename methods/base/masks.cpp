#include "methods/base/masks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include "methods/base/image_io.h"
#include "methods/base/params.h"
#include "methods/base/random.h"

namespace textonbench {
namespace {

constexpr std::string_view rectangles_prefix = "rect:";

void add_rectangle(Mask& mask, const Rectangle& rectangle) {
  for (int y = rectangle.y; y < rectangle.y + rectangle.size.height; ++y) {
    for (int x = rectangle.x; x < rectangle.x + rectangle.size.width; ++x) mask.set(x, y, true);
  }
}

/// How many pixels a percentage means: some are missing and some are known.
std::int64_t asked_pixels(double percent, Extent extent) {
  const std::int64_t area = extent.area();
  return std::clamp<std::int64_t>(std::llround(percent / 100 * static_cast<double>(area)), 1, area - 1);
}

int integer_below(RandomSequence& sequence, int bound) {
  return static_cast<int>(sequence.below(static_cast<std::uint64_t>(bound)));
}

Mask square_mask(double percent, Extent extent, RandomSequence&) {
  const auto asked = static_cast<int>(std::lround(std::sqrt(percent / 100 * static_cast<double>(extent.area()))));
  const int side = std::clamp(asked, 1, std::min(extent.width, extent.height) - 2);
  Mask mask(extent);
  add_rectangle(mask, {(extent.width - side) / 2, (extent.height - side) / 2, {side, side}});
  return mask;
}

/// As many squares as find a place with `gap` pixels between them, at most `number`, by drawing places at random.
std::pair<Mask, std::int64_t> scatter_squares(Extent extent, int side, int gap, std::int64_t number,
                                              RandomSequence& sequence) {
  const Extent places{extent.width - side + 1, extent.height - side + 1};
  Mask mask(extent), taken(places);
  std::int64_t squares = 0;
  // After so many draws few free places are left undrawn.
  const std::int64_t most_draws = 4 * places.area();
  for (std::int64_t draw = 0; draw < most_draws && squares < number; ++draw) {
    const int x = integer_below(sequence, places.width);
    const int y = integer_below(sequence, places.height);
    if (taken.at(x, y)) continue;
    add_rectangle(mask, {x, y, {side, side}});
    const int reach = side + gap - 1;
    const int left = std::max(0, x - reach);
    const int top = std::max(0, y - reach);
    add_rectangle(
        taken,
        {left, top, {std::min(places.width, x + reach + 1) - left, std::min(places.height, y + reach + 1) - top}});
    ++squares;
  }
  return {std::move(mask), squares};
}

Mask holes_mask(double percent, Extent extent, RandomSequence& sequence) {
  const int side = std::clamp(std::min(extent.width, extent.height) / 4, 1, 20);
  const std::int64_t number =
      std::max<std::int64_t>(1, std::llround(percent / 100 * static_cast<double>(extent.area()) / (side * side)));
  Mask mask;
  std::int64_t most = 0;
  for (const int gap : {8, 4, 2, 1}) {
    auto [scattered, squares] = scatter_squares(extent, side, gap, number, sequence);
    if (squares > most) {
      most = squares;
      mask = std::move(scattered);
    }
    if (most == number) break;
  }
  return mask;
}

/// Mean over 2 radius + 1 values of a closed line, values[i * stride] for i < n.
void blur_line(double* values, int n, std::ptrdiff_t stride, int radius, std::vector<double>& line) {
  for (int i = 0; i < n; ++i) line[static_cast<std::size_t>(i)] = values[i * stride];
  const auto wrapped = [&](int i) { return line[static_cast<std::size_t>(((i % n) + n) % n)]; };
  double sum = 0;
  for (int i = -radius; i <= radius; ++i) sum += wrapped(i);
  for (int i = 0; i < n; ++i) {
    values[i * stride] = sum / (2 * radius + 1);
    sum += wrapped(i + radius + 1) - wrapped(i - radius);
  }
}

Mask ragged_mask(double percent, Extent extent, RandomSequence& sequence) {
  const auto [width, height] = extent;
  std::vector<double> field(static_cast<std::size_t>(extent.area()));
  for (double& v : field) v = sequence.normal();
  const int radius = std::max(1, std::min(width, height) / 32);
  std::vector<double> line(static_cast<std::size_t>(std::max(width, height)));
  // Twice: once leaves dust along the edges, and often leaves no ragged edge.
  for (int pass = 0; pass < 2; ++pass) {
    for (int y = 0; y < height; ++y) blur_line(field.data() + std::int64_t{y} * width, width, 1, radius, line);
    for (int x = 0; x < width; ++x) blur_line(field.data() + x, height, width, radius, line);
  }
  std::vector<std::pair<double, std::int64_t>> order;
  order.reserve(field.size());
  for (const double v : field) order.emplace_back(v, static_cast<std::int64_t>(order.size()));
  const auto level = order.begin() + asked_pixels(percent, extent);
  std::nth_element(order.begin(), level, order.end(), std::greater<>());
  Mask mask(extent);
  for (auto highest = order.begin(); highest != level; ++highest) {
    mask.set(static_cast<int>(highest->second % width), static_cast<int>(highest->second / width), true);
  }
  return mask;
}

Mask pixels_mask(double percent, Extent extent, RandomSequence& sequence) {
  // Selection sampling (Knuth, The Art of Computer Programming 2, algorithm S).
  Mask mask(extent);
  std::int64_t wanted = asked_pixels(percent, extent);
  std::int64_t left = extent.area();
  for (int y = 0; y < extent.height; ++y) {
    for (int x = 0; x < extent.width; ++x, --left) {
      if (static_cast<std::int64_t>(sequence.below(static_cast<std::uint64_t>(left))) >= wanted) continue;
      mask.set(x, y, true);
      --wanted;
    }
  }
  return mask;
}

/// Uniform on the circle, without the mathematical library.
std::array<double, 2> random_direction(RandomSequence& sequence) {
  for (;;) {
    const double x = 2 * sequence.uniform() - 1;
    const double y = 2 * sequence.uniform() - 1;
    const double norm = std::sqrt(x * x + y * y);
    if (norm > 0.01 && norm <= 1) return {x / norm, y / norm};
  }
}

Mask lines_mask(double percent, Extent extent, RandomSequence& sequence) {
  Mask mask(extent);
  std::int64_t wanted = asked_pixels(percent, extent);
  const auto add = [&](int x, int y) {
    if (wanted == 0 || x < 0 || y < 0 || x >= extent.width || y >= extent.height || mask.at(x, y)) return;
    mask.set(x, y, true);
    --wanted;
  };
  constexpr double step = 0.5;
  while (wanted > 0) {
    const double x = sequence.uniform() * extent.width;
    const double y = sequence.uniform() * extent.height;
    const auto [across, down] = random_direction(sequence);
    const double length = (0.25 + 0.5 * sequence.uniform()) * std::max(extent.width, extent.height);
    // The last scratch is as short as the percentage wants it.
    for (double t = -length / 2; t <= length / 2 && wanted > 0; t += step) {
      const auto left = static_cast<int>(std::lround(x + t * across));
      const auto top = static_cast<int>(std::lround(y + t * down));
      for (const int i : {left - 1, left}) {
        for (const int j : {top - 1, top}) add(i, j);
      }
    }
  }
  return mask;
}

struct MaskShape {
  std::string_view name;
  Mask (*draw)(double percent, Extent extent, RandomSequence& sequence);
};

constexpr std::array<MaskShape, 5> mask_shapes{{{"square", square_mask},
                                                {"holes", holes_mask},
                                                {"ragged", ragged_mask},
                                                {"pixels", pixels_mask},
                                                {"lines", lines_mask}}};

Mask drawn_mask(const MaskShape& shape, double percent, Extent extent) {
  if (extent.width < 3 || extent.height < 3) {
    throw std::invalid_argument(fmt::format("mask \"{}\" of a picture of {}x{} pixels: expected at least 3x3",
                                            shape.name, extent.width, extent.height));
  }
  RandomSequence sequence(Stream(Seed{1}).child("mask").child(shape.name));
  return shape.draw(percent, extent, sequence);
}

Mask rectangles_mask(const std::string& description, Extent extent) {
  Mask mask(extent);
  std::string_view rest = std::string_view(description).substr(rectangles_prefix.size());
  for (bool more = true; more;) {
    const std::size_t end = rest.find(';');
    more = end != std::string_view::npos;
    const std::string_view text = rest.substr(0, end);
    const Rectangle rectangle = parse_rectangle(text);
    const bool inside = rectangle.x >= 0 && rectangle.y >= 0 &&
                        std::int64_t{rectangle.x} + rectangle.size.width <= extent.width &&
                        std::int64_t{rectangle.y} + rectangle.size.height <= extent.height;
    if (!inside) {
      throw std::invalid_argument(fmt::format("rectangle \"{}\": expected one inside the picture of {}x{} pixels", text,
                                              extent.width, extent.height));
    }
    add_rectangle(mask, rectangle);
    if (more) rest.remove_prefix(end + 1);
  }
  return mask;
}

Mask read_mask(const std::filesystem::path& file, Extent extent) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) {
    std::vector<std::string_view> names;
    names.reserve(mask_shapes.size());
    for (const MaskShape& shape : mask_shapes) names.push_back(shape.name);
    throw std::invalid_argument(fmt::format(
        "mask \"{}\": no such file, and no shape of that name{}; expected a picture, one of {}, or rect:x,y,w,h",
        file.string(), did_you_mean(file.string(), names), fmt::join(names, ", ")));
  }
  const Image picture = read_image(file, {.non_finite = true, .any_alpha = true}).image;
  if (picture.extent() != extent) {
    throw std::invalid_argument(fmt::format("{}: the mask has {}x{} pixels; expected {}x{}, the size of the picture",
                                            file.string(), picture.width(), picture.height(), extent.width,
                                            extent.height));
  }
  Mask mask(extent);
  for (int c = 0; c < picture.channels(); ++c) {
    for (int y = 0; y < extent.height; ++y) {
      for (int x = 0; x < extent.width; ++x) {
        if (picture.at(c, x, y) != 0) mask.set(x, y, true);
      }
    }
  }
  return mask;
}

}  // namespace

Mask make_mask(const std::string& description, double percent, Extent extent) {
  if (!(percent > 0 && percent < 100)) {
    throw std::invalid_argument(
        fmt::format("mask \"{}\" of {} percent: expected more than 0 and less than 100", description, percent));
  }
  const auto shape = std::ranges::find(mask_shapes, std::string_view(description), &MaskShape::name);
  if (shape != mask_shapes.end()) return drawn_mask(*shape, percent, extent);
  if (const auto file = mask_file(description)) return read_mask(*file, extent);
  return rectangles_mask(description, extent);
}

std::optional<std::filesystem::path> mask_file(std::string_view description) {
  const bool is_shape = std::ranges::find(mask_shapes, description, &MaskShape::name) != mask_shapes.end();
  if (is_shape || description.starts_with(rectangles_prefix)) return std::nullopt;
  return std::filesystem::path(description);
}

Rectangle parse_rectangle(std::string_view text) {
  std::array<int, 4> numbers{};
  const char* from = text.data();
  const char* const end = text.data() + text.size();
  bool good = true;
  for (std::size_t i = 0; i < numbers.size() && good; ++i) {
    if (i > 0) good = from != end && *from++ == ',';
    if (!good) break;
    const auto number = std::from_chars(from, end, numbers.at(i));
    good = number.ec == std::errc();
    from = number.ptr;
  }
  if (!good || from != end || numbers[2] < 1 || numbers[3] < 1) {
    throw std::invalid_argument(
        fmt::format("rectangle \"{}\": expected x,y,w,h in pixels, w and h at least 1, such as 78,78,100,100", text));
  }
  return {numbers[0], numbers[1], {numbers[2], numbers[3]}};
}

}  // namespace textonbench
