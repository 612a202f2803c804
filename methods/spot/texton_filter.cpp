#include "methods/spot/texton_filter.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace textonbench {
namespace {

constexpr int most_probes = 16;

/// q beyond which a Gaussian is cut, 3² standard deviations.
constexpr double ellipse_cut = 9;

}  // namespace

MipChain::Level::Level(Extent size)
    : extent(size), texels(stride() * (static_cast<std::size_t>(size.height) + 2), Texel::Zero()) {}

MipChain::MipChain(const Image& coefficients) {
  if (coefficients.channels() > max_channels) {
    throw std::invalid_argument(
        fmt::format("mip chain of {} channels: expected at most {}", coefficients.channels(), max_channels));
  }
  levels_.emplace_back(coefficients.extent());
  for (int y = 0; y < coefficients.height(); ++y) {
    for (int x = 0; x < coefficients.width(); ++x) {
      Texel value = Texel::Zero();
      for (int c = 0; c < coefficients.channels(); ++c) value[c] = coefficients.at(c, x, y);
      levels_[0].set(x, y, value);
    }
  }
  while (levels_.back().extent != Extent{1, 1}) {
    const Level& fine = levels_.back();
    Level coarse({(fine.extent.width + 1) / 2, (fine.extent.height + 1) / 2});
    for (int y = 0; y < coarse.extent.height; ++y) {
      for (int x = 0; x < coarse.extent.width; ++x) {
        coarse.set(x, y,
                   0.25F * (fine.at(2 * x, 2 * y) + fine.at(2 * x + 1, 2 * y) + fine.at(2 * x, 2 * y + 1) +
                            fine.at(2 * x + 1, 2 * y + 1)));
      }
    }
    levels_.push_back(std::move(coarse));
  }
}

Texel MipChain::coefficient(int x, int y) const {
  const auto [width, height] = extent(0);
  return x >= 0 && x < width && y >= 0 && y < height ? texel(0, x, y) : Texel::Zero();
}

Texel MipChain::bilinear(int level, double x, double y) const {
  const double texels = 1.0 / (1 << level);
  const double u = (x + 0.5) * texels + 0.5;  // from the frame's first texel
  const double v = (y + 0.5) * texels + 0.5;
  const Extent size = extent(level);
  if (!(u >= 0 && u < size.width + 1 && v >= 0 && v < size.height + 1)) {
    return Texel::Zero();
  }
  const int left = static_cast<int>(u);
  const int top = static_cast<int>(v);
  const auto right = static_cast<float>(u - left);
  const auto bottom = static_cast<float>(v - top);
  const Texel* upper = &texel(level, left - 1, top - 1);
  const Texel* lower = &texel(level, left - 1, top);
  return (1 - bottom) * ((1 - right) * upper[0] + right * upper[1]) +
         bottom * ((1 - right) * lower[0] + right * lower[1]);
}

Texel MipChain::trilinear(double level, double x, double y) const {
  const int finer = static_cast<int>(level);
  const auto share = static_cast<float>(level - finer);
  const Texel fine = bilinear(finer, x, y);
  return share == 0 ? fine : Texel((1 - share) * fine + share * bilinear(finer + 1, x, y));
}

std::size_t MipChain::bytes() const {
  std::size_t texels = 0;
  for (const Level& level : levels_) texels += level.texels.size();
  return texels * sizeof(Texel);
}

KernelFilter::KernelFilter(TextonFilter filter, const Eigen::Matrix2d& footprint, int coarsest) : filter_(filter) {
  if (!footprint.allFinite() || footprint.determinant() == 0) {
    throw std::invalid_argument(
        fmt::format("footprint with the columns ({}, {}) and ({}, {}): expected finite, independent ones",
                    footprint(0, 0), footprint(1, 0), footprint(0, 1), footprint(1, 1)));
  }
  switch (filter) {
    case TextonFilter::none:
      break;
    case TextonFilter::trilinear:
      prepare_probes(footprint, 1, coarsest);
      break;
    case TextonFilter::anisotropic:
      prepare_probes(footprint, most_probes, coarsest);
      break;
    case TextonFilter::ewa:
      prepare_ellipse(footprint);
      break;
  }
}

void KernelFilter::prepare_probes(const Eigen::Matrix2d& footprint, int most, int coarsest) {
  int longer = 0;
  const double length = footprint.colwise().norm().maxCoeff(&longer);
  const double ratio = length / footprint.col(1 - longer).norm();
  probes_ = ratio < most ? static_cast<int>(std::ceil(ratio)) : most;
  level_ = std::clamp(std::log2(length / probes_), 0.0, static_cast<double>(coarsest));
  axis_ = footprint.col(longer);
  // A texel of T coefficients holds at least one of the kernel, so it ends within T − 1 of the box, and the tent around
  // its center ends T/2 farther. Probes lie within half of the axis.
  const double texel = std::exp2(std::ceil(level_));
  margin_.setConstant(1.5 * texel - 1);
  if (probes_ > 1) margin_ += axis_.cwiseAbs() / 2;
}

void KernelFilter::prepare_ellipse(const Eigen::Matrix2d& footprint) {
  const Eigen::Matrix2d covariance = footprint * footprint.transpose() / 12 + Eigen::Matrix2d::Identity() / 6;
  conic_ = covariance.inverse();
  half_box_ = (ellipse_cut * covariance.diagonal()).cwiseSqrt();
  margin_ = half_box_.array() - 0.5;
}

double KernelFilter::texels() const {
  switch (filter_) {
    case TextonFilter::none:
      return 4;
    case TextonFilter::ewa:
      return std::numbers::pi * ellipse_cut / std::sqrt(conic_.determinant());
    case TextonFilter::trilinear:
    case TextonFilter::anisotropic:
      break;
  }
  const bool one_level = level_ == std::floor(level_);
  return probes_ * (one_level ? 4 : 8);
}

Texel KernelFilter::operator()(const MipChain& kernel, double x, double y) const {
  switch (filter_) {
    case TextonFilter::none:
      return kernel.bilinear(0, x, y);
    case TextonFilter::ewa:
      return elliptic_sum(kernel, x, y);
    case TextonFilter::trilinear:
    case TextonFilter::anisotropic:
      break;
  }
  if (probes_ == 1) return kernel.trilinear(level_, x, y);
  Texel sum = Texel::Zero();
  for (int i = 1; i <= probes_; ++i) {
    const double place = i / (probes_ + 1.0) - 0.5;
    sum += kernel.trilinear(level_, x + place * axis_.x(), y + place * axis_.y());
  }
  return sum / static_cast<float>(probes_);
}

Texel KernelFilter::elliptic_sum(const MipChain& kernel, double x, double y) const {
  const auto first = [](double center, double half) { return static_cast<int>(std::ceil(center - half)); };
  const auto last = [](double center, double half) { return static_cast<int>(std::floor(center + half)); };
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  double total = 0;
  for (int j = first(y, half_box_.y()); j <= last(y, half_box_.y()); ++j) {
    for (int i = first(x, half_box_.x()); i <= last(x, half_box_.x()); ++i) {
      const double dx = x - i;
      const double dy = y - j;
      const double q = conic_(0, 0) * dx * dx + 2 * conic_(0, 1) * dx * dy + conic_(1, 1) * dy * dy;
      if (q <= ellipse_cut) {
        const double weight = std::exp(-q / 2);
        total += weight;
        sum += weight * kernel.coefficient(i, j).cast<double>();
      }
    }
  }
  return (sum / total).cast<float>();
}

}  // namespace textonbench
