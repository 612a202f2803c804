#include "methods/sparse/gabor_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace textonbench {
namespace {

/// 2π ∫_0^R r g(r)² f(r) dr by Simpson's rule.
template <class Function>
double radial_integral(const GaborBand& band, const Function& function) {
  constexpr int nodes = 2000;
  const double step = band.radius / nodes;
  double sum = 0;
  for (int i = 0; i <= nodes; ++i) {
    const double r = i * step;
    const double weight = i == 0 || i == nodes ? 1 : i % 2 == 1 ? 4 : 2;
    sum += weight * r * std::exp(-2 * std::numbers::pi * std::pow(band.bandwidth * r, 2)) * function(r);
  }
  return 2 * std::numbers::pi * sum * step / 3;
}

}  // namespace

std::size_t GaborBand::bytes() const {
  return sizeof(GaborFrequency) * frequency.size() + sizeof(std::uint32_t) * chance.size() +
         sizeof(std::complex<float>) * color.size();
}

double gabor_radius(double bandwidth, double cut) { return std::sqrt(-std::log(cut) / std::numbers::pi) / bandwidth; }

double gabor_energy(const GaborBand& band) {
  return radial_integral(band, [](double) { return 1.0; });
}

double gabor_imbalance(const GaborBand& band, const GaborFrequency& frequency) {
  const double turns = 4 * std::numbers::pi * std::hypot(frequency.x, frequency.y);
  return radial_integral(band, [turns](double r) { return std::cyl_bessel_j(0, turns * r); });
}

GaborImpacts::GaborImpacts(const GaborField& field, std::size_t band, Seed seed)
    : field_(&field),
      band_(&field.bands[band]),
      grid_(field.process, band_->intensity, band_->radius, 1),
      key_(Stream(seed).child("gabor").child(band).key()),
      kernel_key_(Stream(seed).child("gabor").child(band).child("kernel").key()) {}

void GaborImpacts::draw(const PlaneRectangle& rectangle, std::vector<GaborImpact>& impacts) {
  drawn_.clear();
  grid_.draw(key_, rectangle, drawn_);
  for (const PlaneImpact& impact : drawn_) {
    const auto words =
        philox_block(kernel_key_, static_cast<std::uint64_t>(impact.y), static_cast<std::uint64_t>(impact.x));
    const auto entry = std::ranges::upper_bound(band_->chance, words[0]) - band_->chance.begin();
    std::uint32_t phase = words[1];
    if (field_->phase != GaborPhase::random) phase = field_->phase == GaborPhase::cosine ? 0 : 0xC0000000U;
    float weight = impact.weight;
    if (field_->weight == GaborWeight::uniform) {
      weight *= static_cast<float>(static_cast<double>(words[2]) * 0x1p-31 + 0x1p-32 - 1);
    }
    const auto last = static_cast<std::ptrdiff_t>(band_->frequency.size()) - 1;
    impacts.push_back({impact.x, impact.y, weight, phase, static_cast<std::uint32_t>(std::min(entry, last))});
  }
}

}  // namespace textonbench
