#include "methods/spot/support.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "methods/base/image_io.h"

namespace textonbench {
namespace {

/// S in the box where contains(x, y). The box must be the bounding one.
template <class Contains>
Support make_support(Extent box, const Contains& contains) {
  Support support{box, {}, 0};
  support.inside.reserve(static_cast<std::size_t>(box.area()));
  for (int y = 0; y < box.height; ++y) {
    for (int x = 0; x < box.width; ++x) {
      support.inside.push_back(contains(x, y) ? 1 : 0);
      support.pixels += support.inside.back();
    }
  }
  return support;
}

void require_size(std::string_view what, int size, int least) {
  if (size < least) {
    throw std::invalid_argument(fmt::format("support: {} {}, expected at least {}", what, size, least));
  }
}

/// The size of the options' disc or square, before it is made: an oversized one would need its memory.
Extent asked_box(const std::string& shape, std::int64_t size) {
  constexpr std::int64_t most = 1 << 20;
  const auto side = static_cast<int>(std::min(most, shape == "disc" ? 2 * std::min(size, most) + 1 : size));
  return {side, side};
}

void require_fit(Extent box, Extent exemplar) {
  if (box.width > exemplar.width || box.height > exemplar.height) {
    throw std::invalid_argument(fmt::format("support of {}x{} pixels: expected no more than the exemplar's {}x{}",
                                            box.width, box.height, exemplar.width, exemplar.height));
  }
}

}  // namespace

Support square_support(int side) { return rectangle_support({side, side}); }

Support rectangle_support(Extent box) {
  require_size("width", box.width, 1);
  require_size("height", box.height, 1);
  return make_support(box, [](int, int) { return true; });
}

Support disc_support(int radius) {
  require_size("radius", radius, 0);
  const int side = 2 * radius + 1;
  return make_support({side, side}, [&](int x, int y) {
    const std::int64_t dx = x - radius;
    const std::int64_t dy = y - radius;
    return dx * dx + dy * dy <= std::int64_t{radius} * radius;
  });
}

Support mask_support(const Image& mask) {
  const auto contains = [&](int x, int y) {
    for (int c = 0; c < mask.channels(); ++c) {
      if (mask.at(c, x, y) != 0) {
        return true;
      }
    }
    return false;
  };
  int left = mask.width();
  int right = -1;
  int top = mask.height();
  int bottom = -1;
  for (int y = 0; y < mask.height(); ++y) {
    for (int x = 0; x < mask.width(); ++x) {
      if (contains(x, y)) {
        left = std::min(left, x);
        right = std::max(right, x);
        top = std::min(top, y);
        bottom = std::max(bottom, y);
      }
    }
  }
  if (right < 0) {
    throw std::invalid_argument(fmt::format(
        "support mask of {}x{} pixels is zero everywhere, expected one pixel inside", mask.width(), mask.height()));
  }
  return make_support({right - left + 1, bottom - top + 1}, [&](int x, int y) { return contains(left + x, top + y); });
}

std::vector<SupportRun> support_runs(const Support& support) {
  std::vector<SupportRun> runs;
  runs.reserve(static_cast<std::size_t>(support.box.height));
  for (int y = 0; y < support.box.height; ++y) {
    const auto row = support.inside.begin() + std::ptrdiff_t{y} * support.box.width;
    const auto end = row + support.box.width;
    for (auto first = std::find(row, end, 1); first != end;) {
      const auto last = std::find(first, end, 0);
      runs.push_back({y, static_cast<int>(first - row), static_cast<int>(last - row)});
      first = std::find(last, end, 1);
    }
  }
  return runs;
}

Image support_image(const Support& support) {
  Image image(support.box, 1);
  auto inside = support.inside.begin();
  for (int y = 0; y < image.height(); ++y) {
    for (float& v : image.row(0, y)) {
      v = *inside++ != 0 ? 1.0F : 0.0F;
    }
  }
  return image;
}

double spline_support_area(const Support& support, int order) {
  // The squares consist of whole cells between the splines' knots, order + 1 of them on each side.
  const int width = support.box.width + order;
  const int height = support.box.height + order;
  std::vector<std::uint8_t> covered(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (const SupportRun& run : support_runs(support)) {
    for (int y = run.y; y <= run.y + order; ++y) {
      const auto row = covered.begin() + std::ptrdiff_t{y} * width;
      std::fill(row + run.first, row + run.last + order, std::uint8_t{1});
    }
  }
  return static_cast<double>(std::ranges::count(covered, std::uint8_t{1}));
}

Image crop_to_support(const Image& torus, int left, int top, const Support& support) {
  require_fit(support.box, torus.extent());
  const auto wrap = [](int v, int n) { return ((v % n) + n) % n; };
  Image cropped(support.box, torus.channels());
  for (const SupportRun& run : support_runs(support)) {
    for (int c = 0; c < torus.channels(); ++c) {
      const auto source = torus.row(c, wrap(top + run.y, torus.height()));
      for (int x = run.first; x < run.last; ++x) {
        cropped.at(c, x, run.y) = source[static_cast<std::size_t>(wrap(left + x, torus.width()))];
      }
    }
  }
  return cropped;
}

std::vector<ParamSpec> support_params(int default_support) {
  return {{.name = "support",
           .default_value = std::int64_t{default_support},
           .unit = "pixel",
           .help = "side of a square support, radius of a disc; 0: the whole exemplar",
           .min = 0},
          {.name = "shape",
           .default_value = std::string("square"),
           .unit = "",
           .help = "form of the support; mask: the pixels of the image \"mask\" that are not zero",
           .choices = {"square", "disc", "mask"}},
          {.name = "mask",
           .default_value = std::string(),
           .unit = "file",
           .help = "image file of the support when shape is mask"}};
}

Support support_of(const Params& params, Extent exemplar) {
  const std::string& shape = params.text("shape");
  const std::string& file = params.text("mask");
  if (shape != "mask" && !file.empty()) {
    throw std::invalid_argument(fmt::format("mask \"{}\" with shape \"{}\": expected shape \"mask\"", file, shape));
  }
  if (shape == "mask") {
    if (file.empty()) {
      throw std::invalid_argument("shape \"mask\" needs the option mask, an image file");
    }
    try {
      Support support = mask_support(read_image(file).image);
      require_fit(support.box, exemplar);
      return support;
    } catch (const std::invalid_argument& error) {
      const std::string message = error.what();
      throw std::invalid_argument(message.find(file) == std::string::npos ? fmt::format("{}: {}", file, message)
                                                                          : message);
    }
  }
  const std::int64_t size = params.integer("support");
  if (size == 0) {
    return rectangle_support(exemplar);
  }
  require_fit(asked_box(shape, size), exemplar);
  return shape == "disc" ? disc_support(static_cast<int>(size)) : square_support(static_cast<int>(size));
}

}  // namespace textonbench
