#include "experiments/statistics/crossing.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace textonbench {
namespace {

/// Of the curve y exp(deviations error / y).
double crossing_of(std::span<const MeasuredPoint> points, double level, double deviations) {
  const auto height = [&](const MeasuredPoint& p) { return std::log(p.y / level) + deviations * p.error / p.y; };
  std::size_t after = points.size();
  while (after > 0 && height(points[after - 1]) <= 0) --after;
  if (after == 0) return 0;
  if (after == points.size()) return std::numeric_limits<double>::infinity();
  const MeasuredPoint& last_above = points[after - 1];
  const MeasuredPoint& first_below = points[after];
  const double part = height(last_above) / (height(last_above) - height(first_below));
  return last_above.x * std::pow(first_below.x / last_above.x, part);
}

}  // namespace

Estimate log_log_crossing(std::span<const MeasuredPoint> points, double level) {
  if (points.empty() || !(level > 0 && std::isfinite(level))) {
    throw std::invalid_argument(fmt::format(
        "crossing of the level {} by {} points: expected a positive level and points", level, points.size()));
  }
  double before = 0;
  for (const MeasuredPoint& p : points) {
    if (!(p.x > before && std::isfinite(p.x) && p.y > 0 && std::isfinite(p.y) && p.error >= 0 &&
          std::isfinite(p.error))) {
      throw std::invalid_argument(
          fmt::format("crossing: point ({}, {} ± {}) after x = {}: expected ascending x and positive, finite numbers",
                      p.x, p.y, p.error, before));
    }
    before = p.x;
  }
  constexpr double quantile = 1.959964;
  return {crossing_of(points, level, 0), crossing_of(points, level, -quantile), crossing_of(points, level, quantile)};
}

}  // namespace textonbench
