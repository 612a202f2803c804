#include "methods/base/ground_view.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string_view>

namespace textonbench {
namespace {

double require_inside(std::string_view what, double value, double above, double below) {
  if (!(value > above && value < below)) {
    throw std::invalid_argument(
        fmt::format("view of the ground: {} = {}, expected between {} and {}", what, value, above, below));
  }
  return value;
}

}  // namespace

GroundView::GroundView(Extent size, const GroundViewOptions& options)
    : middle_((size.width - 1) / 2.0, (size.height - 1) / 2.0),
      height_(require_inside("height", options.height, 0, 1e9)),
      focal_(size.width / 2.0 / std::tan(require_inside("field", options.field, 0, std::numbers::pi) / 2)),
      sine_(std::sin(require_inside("pitch", options.pitch, 0, std::numbers::pi / 2))),
      cosine_(std::cos(options.pitch)),
      furthest_(require_inside("furthest", options.furthest, 0, 1e6)) {}

bool GroundView::covers(double x, double y) const {
  // s falls by less than 1/2 to the upper side of the pixel: all of it is below the horizon.
  return depth(y) >= 1 && footprint(x, y).colwise().norm().maxCoeff() <= furthest_;
}

Eigen::Vector2d GroundView::point(double x, double y) const {
  return height_ / depth(y) * Eigen::Vector2d(x - middle_.x(), (y - middle_.y()) * sine_ - focal_ * cosine_);
}

Eigen::Matrix2d GroundView::footprint(double x, double y) const {
  const double s = depth(y);
  Eigen::Matrix2d derivatives;
  derivatives << 1, -(x - middle_.x()) * cosine_ / s, 0, focal_ / s;
  return height_ / s * derivatives;
}

}  // namespace textonbench
