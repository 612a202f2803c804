#include "methods/conditional/gaussian_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace textonbench {

GaussianField estimate_field(const Image& u, const Mask& missing) {
  if (u.extent() != missing.extent()) {
    throw std::invalid_argument(fmt::format("a mask of {}x{} for a picture of {}x{}: expected the same size",
                                            missing.extent().width, missing.extent().height, u.width(), u.height()));
  }
  const std::int64_t known = u.extent().area() - missing.count();
  if (known < least_known_pixels) {
    throw std::invalid_argument(
        fmt::format("{} known pixels to estimate a model from: expected at least {}; a model of another exemplar needs "
                    "none",
                    known, least_known_pixels));
  }
  GaussianField field;
  field.spot = Planes(u.extent(), u.channels());
  double largest_deviation = 0;
  for (int c = 0; c < u.channels(); ++c) {
    double sum = 0;
    for (int y = 0; y < u.height(); ++y) {
      for (int x = 0; x < u.width(); ++x) {
        if (missing.at(x, y)) continue;
        const float value = u.at(c, x, y);
        if (!std::isfinite(value)) {
          throw std::invalid_argument(fmt::format(
              "channel {} of the known pixel ({}, {}) is {}: expected a finite number", c + 1, x, y, value));
        }
        sum += static_cast<double>(value);
      }
    }
    const double mean = sum / static_cast<double>(known);
    field.mean.push_back(mean);
    const double scale = 1 / std::sqrt(static_cast<double>(known));
    for (int y = 0; y < u.height(); ++y) {
      double* out = field.spot.row(c, y);
      for (int x = 0; x < u.width(); ++x) {
        if (missing.at(x, y)) continue;
        const double deviation = static_cast<double>(u.at(c, x, y)) - mean;
        largest_deviation = std::max(largest_deviation, std::fabs(deviation));
        out[x] = scale * deviation;
      }
    }
  }
  // Samples are float32 numbers near 1: what is below is rounding.
  if (largest_deviation < 1e-6) {
    throw std::invalid_argument("the known pixels are all of one color: expected a texture to estimate a model from");
  }
  return field;
}

double mean_variance(const GaussianField& field) {
  const std::vector<double>& t = field.spot.data;
  return std::inner_product(t.begin(), t.end(), t.begin(), 0.0) / field.channels();
}

}  // namespace textonbench
