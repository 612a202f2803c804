#include "methods/sparse/gabor_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace textonbench {

double GaborWindow::limit() const { return -std::log(cut) / std::numbers::pi; }
double GaborWindow::half_width() const { return std::sqrt(limit() * yy / determinant()); }
double GaborWindow::half_height() const { return std::sqrt(limit() * xx / determinant()); }
double GaborWindow::area() const { return std::numbers::pi * limit() / std::sqrt(determinant()); }

std::size_t GaborBand::bytes() const {
  return sizeof(GaborFrequency) * frequency.size() + 2 * sizeof(std::uint32_t) * threshold.size() +
         sizeof(std::complex<float>) * color.size();
}

void GaborBand::draw_by(std::span<const double> weights) {
  const std::size_t count = weights.size();
  threshold.assign(count, 0xFFFFFFFFU), alias.resize(count);
  std::iota(alias.begin(), alias.end(), 0U);
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  std::vector<double> left(weights.begin(), weights.end());
  std::vector<std::uint32_t> poor, rich;
  for (std::uint32_t e = 0; e < count; ++e) {
    left[e] *= static_cast<double>(count) / sum;
    (left[e] < 1 ? poor : rich).push_back(e);
  }
  while (!poor.empty() && !rich.empty()) {
    const std::uint32_t from = rich.back(), to = poor.back();
    poor.pop_back();
    threshold[to] = static_cast<std::uint32_t>(std::clamp(left[to] * 0x1p32, 0.0, 0x1p32 - 1));
    alias[to] = from;
    left[from] -= 1 - left[to];
    if (left[from] < 1) {
      rich.pop_back();
      poor.push_back(from);
    }
  }
}

std::vector<double> GaborBand::chances() const {
  const std::size_t count = threshold.size();
  std::vector<double> all(count);
  for (std::size_t e = 0; e < count; ++e) {
    const double kept = alias[e] == e ? 1 : threshold[e] * 0x1p-32;
    all[e] += kept / static_cast<double>(count);
    all[alias[e]] += (1 - kept) / static_cast<double>(count);
  }
  return all;
}

double gabor_imbalance(const GaborWindow& window, const GaborFrequency& f) {
  // In the coordinates where the form is r²: 2π ∫ r exp(−2π r²) J_0(4π |f'| r) dr by Simpson's rule.
  const double det = window.determinant();
  const double turns = 4 * std::numbers::pi *
                       std::sqrt((window.yy * f.x * f.x - 2 * window.xy * f.x * f.y + window.xx * f.y * f.y) / det);
  constexpr int nodes = 2000;
  const double step = std::sqrt(window.limit()) / nodes;
  double sum = 0;
  for (int i = 0; i <= nodes; ++i) {
    const double r = i * step;
    const double weight = i == 0 || i == nodes ? 1 : i % 2 == 1 ? 4 : 2;
    sum += weight * r * std::exp(-2 * std::numbers::pi * r * r) * std::cyl_bessel_j(0, turns * r);
  }
  return 2 * std::numbers::pi * sum * step / 3 / std::sqrt(det);
}

GaborImpacts::GaborImpacts(const GaborField& field, std::size_t band, Seed seed)
    : field_(&field),
      band_(&field.bands[band]),
      grid_(field.process, band_->intensity, band_->cell, 1),
      key_(Stream(seed).child("gabor").child(band).key()),
      kernel_key_(Stream(seed).child("gabor").child(band).child("kernel").key()) {}

void GaborImpacts::draw(const PlaneRectangle& rectangle, std::vector<GaborImpact>& impacts) {
  drawn_.clear();
  grid_.draw(key_, rectangle, drawn_);
  for (const PlaneImpact& impact : drawn_) {
    const auto words =
        philox_block(kernel_key_, static_cast<std::uint64_t>(impact.y), static_cast<std::uint64_t>(impact.x));
    const std::uint64_t place = std::uint64_t{words[0]} * band_->threshold.size();
    auto entry = static_cast<std::uint32_t>(place >> 32U);
    if (static_cast<std::uint32_t>(place) >= band_->threshold[entry]) entry = band_->alias[entry];
    std::uint32_t phase = words[1];
    if (field_->phase != GaborPhase::random) phase = field_->phase == GaborPhase::cosine ? 0 : 0xC0000000U;
    float weight = impact.weight;
    if (field_->weight == GaborWeight::uniform) {
      weight *= static_cast<float>(static_cast<double>(words[2]) * 0x1p-31 + 0x1p-32 - 1);
    }
    impacts.push_back({impact.x, impact.y, weight, phase, entry});
  }
}

}  // namespace textonbench
