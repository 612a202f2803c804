#include "methods/base/bspline.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace textonbench {
namespace {

void require_order(int order, int least) {
  if (order < least || order > max_bspline_order) {
    throw std::invalid_argument(fmt::format("B-spline order {}; expected {} to {}", order, least, max_bspline_order));
  }
}

// Weights of the order + 1 taps at a position that is `t` in [0, 1) beyond the first point where they are the right
// ones, by the recurrence of Cox and de Boor.
std::array<double, max_bspline_order + 1> weights_at(int order, double t) {
  std::array<double, max_bspline_order + 1> weights{1};
  for (int n = 1; n <= order; ++n) {
    double carried = 0;
    for (int i = 0; i < n; ++i) {
      const double share = weights[static_cast<std::size_t>(i)] / n;
      weights[static_cast<std::size_t>(i)] = carried + (i + 1 - t) * share;
      carried = (t + n - i - 1) * share;
    }
    weights[static_cast<std::size_t>(n)] = carried;
  }
  return weights;
}

struct Place {
  std::int64_t first;  // tap
  double t;            // position between knots, in [0, 1)
};

Place place_of(int order, double x) {
  // The knots of even orders lie at half-integers.
  const double shifted = order % 2 == 0 ? x + 0.5 : x;
  const double knot = std::floor(shifted);
  return {.first = static_cast<std::int64_t>(knot) - order / 2, .t = shifted - knot};
}

std::vector<double> samples_of_autocorrelation(int order) {
  std::vector<double> samples;
  samples.reserve(static_cast<std::size_t>(order) + 1);
  for (int j = 0; j <= order; ++j) {
    samples.push_back(bspline(2 * order + 1, j));
  }
  return samples;
}

}  // namespace

double bspline(int order, double x) {
  const int highest = 2 * max_bspline_order + 1;
  if (order < 0 || order > highest) {
    throw std::invalid_argument(fmt::format("B-spline order {}; expected 0 to {}", order, highest));
  }
  if (order == 0) {
    return x >= -0.5 && x < 0.5 ? 1 : 0;
  }
  const double half = (order + 1) / 2.0;
  if (std::abs(x) >= half) {
    return 0;
  }
  return ((half + x) * bspline(order - 1, x + 0.5) + (half - x) * bspline(order - 1, x - 0.5)) / order;
}

BsplineTaps bspline_taps(int order, double x) {
  require_order(order, 0);
  const Place place = place_of(order, x);
  return {.first = place.first, .weights = weights_at(order, place.t)};
}

BsplineTaps bspline_derivative_taps(int order, double x) {
  require_order(order, 1);
  const Place place = place_of(order, x);
  // β^n' (x) = β^(n−1)(x + 1/2) − β^(n−1)(x − 1/2), and both orders have the same knots once shifted by 1/2.
  const auto lower = weights_at(order - 1, place.t);
  BsplineTaps taps{.first = place.first, .weights = {}};
  for (int i = 0; i <= order; ++i) {
    const double before = i > 0 ? lower[static_cast<std::size_t>(i) - 1] : 0;
    const double here = i < order ? lower[static_cast<std::size_t>(i)] : 0;
    taps.weights[static_cast<std::size_t>(i)] = before - here;
  }
  return taps;
}

std::span<const double> bspline_autocorrelation(int order) {
  require_order(order, 0);
  static const auto all = [] {
    std::array<std::vector<double>, max_bspline_order + 1> samples;
    for (int n = 0; n <= max_bspline_order; ++n) {
      samples[static_cast<std::size_t>(n)] = samples_of_autocorrelation(n);
    }
    return samples;
  }();
  return all[static_cast<std::size_t>(order)];
}

double bspline_power(int order, double frequency) {
  const std::span<const double> b = bspline_autocorrelation(order);
  double sum = b[0];
  for (std::size_t j = 1; j < b.size(); ++j) {
    sum += 2 * b[j] * std::cos(2 * std::numbers::pi * frequency * static_cast<double>(j));
  }
  return sum;
}

}  // namespace textonbench
