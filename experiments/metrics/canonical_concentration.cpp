#include "experiments/metrics/canonical_concentration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "methods/spot/zero_phase_texton.h"

namespace textonbench {
namespace {

struct Canonical {
  GaussianModel gray;
  Image texton;
};

std::optional<Canonical> canonical_of(const Target& target) {
  const Image& color = target.periodic_component;
  Image gray(color.extent(), 1);
  for (int c = 0; c < color.channels(); ++c) {
    for (int y = 0; y < color.height(); ++y) {
      const auto from = color.row(c, y);
      const auto to = gray.row(0, y);
      for (std::size_t x = 0; x < to.size(); ++x) to[x] += from[x] / static_cast<float>(color.channels());
    }
  }
  GaussianModel model = gaussian_model(std::move(gray));
  if (color_covariance(model.spectrum).trace() < 1e-12) return std::nullopt;
  Texton texton = zero_phase_texton(model, std::array{1.0}, rectangle_support(color.extent()));
  return Canonical{std::move(model), std::move(texton.kernels.front())};
}

}  // namespace

double central_energy(const Image& image, double area_part) {
  const double radius_squared = area_part * static_cast<double>(image.extent().area()) / std::numbers::pi;
  double inside = 0, all = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const double energy = std::pow(static_cast<double>(image.at(0, x, y)), 2);
      const int dx = x - image.width() / 2, dy = y - image.height() / 2;
      all += energy;
      if (dx * dx + dy * dy <= radius_squared) inside += energy;
    }
  }
  return inside / all;
}

std::optional<double> canonical_central_energy(const Model&, const Target& target, const Domain&) {
  const auto canonical = canonical_of(target);
  return canonical ? std::optional(central_energy(canonical->texton, 0.01)) : std::nullopt;
}

std::optional<double> canonical_side_peak(const Model&, const Target& target, const Domain&) {
  const auto canonical = canonical_of(target);
  if (!canonical) return std::nullopt;
  const Image& t = canonical->texton;
  float largest = 0;
  for (int y = 0; y < t.height(); ++y) {
    for (int x = 0; x < t.width(); ++x) {
      if (x != t.width() / 2 || y != t.height() / 2) largest = std::max(largest, std::fabs(t.at(0, x, y)));
    }
  }
  return largest / t.at(0, t.width() / 2, t.height() / 2);
}

std::optional<double> canonical_law_error(const Model&, const Target& target, const Domain&) {
  const auto canonical = canonical_of(target);
  if (!canonical) return std::nullopt;
  CrossSpectrum law;
  law.factors.push_back(forward_fft(canonical->texton));
  return relative_model_error(law, canonical->gray.spectrum);
}

}  // namespace textonbench
