#include "methods/sparse/gabor_filter.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace textonbench {
namespace {

constexpr double widest_filtered_kernel = 512;

void require_covariance(const Eigen::Matrix2d& covariance) {
  const double trace = covariance.trace();
  // A footprint that is a line has a determinant of 0 to rounding.
  if (!(covariance.allFinite() && covariance(0, 1) == covariance(1, 0) && covariance.diagonal().minCoeff() >= 0 &&
        covariance.determinant() >= -1e-12 * trace * trace)) {
    throw std::invalid_argument(
        fmt::format("gabor filtered by a covariance of ({}, {}; {}, {}): expected a finite matrix, symmetric and "
                    "positive semidefinite",
                    covariance(0, 0), covariance(0, 1), covariance(1, 0), covariance(1, 1)));
  }
}

void filter_band(const Eigen::Matrix2d& covariance, int channels, GaborBand& band) {
  GaborWindow& window = band.window;
  Eigen::Matrix2d form;
  form << window.xx, window.xy, window.xy, window.yy;
  const Eigen::Matrix2d spread = form.inverse();
  const Eigen::Matrix2d filtered = (spread + 2 * std::numbers::pi * covariance).inverse();
  const Eigen::Matrix2d loss = spread - spread * filtered * spread;
  const double height = std::sqrt(filtered.determinant() / form.determinant());
  window.xx = filtered(0, 0), window.xy = filtered(0, 1), window.yy = filtered(1, 1);
  if (!(std::max(window.half_width(), window.half_height()) <= widest_filtered_kernel)) {
    throw std::invalid_argument(
        fmt::format("gabor with kernels that a filter widens to a box of {:.0f} x {:.0f} pixels around "
                    "their middle: expected at most {}",
                    window.half_width(), window.half_height(), widest_filtered_kernel));
  }
  band.raster = {};
  const auto stride = static_cast<std::size_t>(channels);
  for (std::size_t e = 0; e < band.frequency.size(); ++e) {
    const Eigen::Vector2d f(band.frequency[e].x, band.frequency[e].y);
    const Eigen::Vector2d moved = filtered * spread * f;
    band.frequency[e] = {moved.x(), moved.y()};
    const auto part = static_cast<float>(height * std::exp(-std::numbers::pi * f.dot(loss * f)));
    for (std::size_t c = 0; c < stride; ++c) band.color[e * stride + c] *= part;
  }
}

}  // namespace

GaborField filtered_gabor(const GaborField& field, const Eigen::Matrix2d& covariance) {
  require_covariance(covariance);
  GaborField filtered = field;
  for (GaborBand& band : filtered.bands) filter_band(covariance, field.channels, band);
  return filtered;
}

GaborField filtered_gabor(const GaborField& field, double footprint) {
  if (footprint == 0) return field;
  return filtered_gabor(field, Eigen::Matrix2d(footprint * footprint / 12 * Eigen::Matrix2d::Identity()));
}

std::optional<std::string> refuse_footprint(const GaborWindow& window, double footprint) {
  const double spread = 1 / window.xx + 2 * std::numbers::pi * footprint * footprint / 12;
  const double radius = std::sqrt(window.limit() * spread);
  if (radius <= widest_filtered_kernel) return std::nullopt;
  return fmt::format(
      "gabor filtered for pixels of {}: its kernels would have a radius of {:.0f} pixels; expected at most {}",
      footprint, radius, widest_filtered_kernel);
}

ParamSpec footprint_param() {
  return {
      .name = "footprint",
      .default_value = 0.0,
      .unit = "pixel",
      .help =
          "side of the pixels that kernels are filtered for, by a Gaussian of their variance; 0 is values at points",
      .min = 0,
      .max = 1024};
}

}  // namespace textonbench
