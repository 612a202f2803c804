#include "methods/base/exemplar.h"

#include <fmt/format.h>

#include <stdexcept>

namespace textonbench {

void require_usable(const Exemplar& exemplar) {
  const Image& u = exemplar.pixels;
  if (u.empty()) {
    throw std::invalid_argument(fmt::format("exemplar \"{}\" has no pixels", exemplar.name));
  }
  if (u.width() < 2 || u.height() < 2) {
    throw std::invalid_argument(
        fmt::format("exemplar \"{}\" is {}x{} pixels: expected at least 2x2", exemplar.name, u.width(), u.height()));
  }
  if (const std::size_t named = channel_names(exemplar.maps).size();
      named != 0 && named != static_cast<std::size_t>(u.channels())) {
    throw std::invalid_argument(fmt::format("exemplar \"{}\" has {} channels, and maps of {}: expected as many",
                                            exemplar.name, u.channels(), named));
  }
  if (const auto bad = find_non_finite(u)) {
    throw std::invalid_argument(fmt::format("exemplar \"{}\": sample {} at x {}, y {}, channel {} is not finite",
                                            exemplar.name, u.at(bad->channel, bad->x, bad->y), bad->x, bad->y,
                                            bad->channel));
  }
  for (int c = 0; c < u.channels(); ++c) {
    for (int y = 0; y < u.height(); ++y) {
      for (const float v : u.row(c, y)) {
        if (v != u.at(c, 0, 0)) {
          return;
        }
      }
    }
  }
  throw std::invalid_argument(fmt::format("exemplar \"{}\" is constant: there is no texture to model", exemplar.name));
}

}  // namespace textonbench
