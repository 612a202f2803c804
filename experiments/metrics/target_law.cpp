#include "experiments/metrics/target_law.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace textonbench {
namespace {

CrossSpectrum law_spectrum(const Target& target, Extent grid) {
  CrossSpectrum spectrum;
  spectrum.factors.push_back(spot_spectrum(target, grid));
  return spectrum;
}

/// The torus, or a grid on which lags up to `reach` of a covariance that ends at `extent` do not wrap round.
Extent grid_of(const Domain& domain, Extent extent, Extent reach) {
  if (domain.periodic) return domain.size;
  return {good_fft_size(extent.width + reach.width), good_fft_size(extent.height + reach.height)};
}

}  // namespace

Spectrum spot_spectrum(const Target& target, Extent grid) {
  const Spectrum& own = target.gaussian.spectrum.factors.front();
  if (own.raster() == grid) return own;
  const Image spot = inverse_fft(own);
  Image folded(grid, spot.channels());
  for (int c = 0; c < spot.channels(); ++c) {
    for (int y = 0; y < spot.height(); ++y) {
      const auto from = spot.row(c, y);
      const auto to = folded.row(c, y % grid.height);
      for (std::size_t x = 0; x < from.size(); ++x) to[x % to.size()] += from[x];
    }
  }
  return forward_fft(folded);
}

LagWindow::LagWindow(const Target& target, const Domain& domain, Extent reach)
    : channels_(target.covariance.channels), reach_(reach) {
  require_unit_step(domain);
  Autocovariance elsewhere;
  const bool own = on_own_torus(target, domain);
  if (!own) {
    elsewhere = autocovariance(law_spectrum(target, grid_of(domain, target.covariance.grid, reach)));
  }
  read(own ? target.covariance : elsewhere);
}

LagWindow::LagWindow(const Gaussian& law, Extent extent, const Domain& domain, Extent reach)
    : channels_(static_cast<int>(law.mean().size())), reach_(reach) {
  require_unit_step(domain);
  read(autocovariance(law.spectrum(grid_of(domain, extent, reach))));
}

void LagWindow::read(const Autocovariance& covariance) {
  values_.reserve(static_cast<std::size_t>(channels_ * channels_) * static_cast<std::size_t>(2 * reach_.width + 1) *
                  static_cast<std::size_t>(2 * reach_.height + 1));
  for (int c = 0; c < channels_; ++c) {
    for (int d = 0; d < channels_; ++d) {
      for (int y = -reach_.height; y <= reach_.height; ++y) {
        for (int x = -reach_.width; x <= reach_.width; ++x) values_.push_back(covariance.at(c, d, x, y));
      }
    }
  }
}

std::vector<double> channel_deviations(const Target& target) {
  std::vector<double> deviations(static_cast<std::size_t>(target.covariance.channels));
  for (int c = 0; c < target.covariance.channels; ++c) {
    deviations[static_cast<std::size_t>(c)] = std::sqrt(std::max(0.0, target.covariance.at(c, c, 0, 0)));
  }
  const double negligible = std::sqrt(1e-9) * *std::ranges::max_element(deviations);
  for (double& deviation : deviations) {
    if (deviation <= negligible) deviation = 0;
  }
  return deviations;
}

Image centered(const Image& sample, std::span<const double> mean, Extent size) {
  Image result(size, sample.channels());
  for (int c = 0; c < sample.channels(); ++c) {
    const double m = mean[static_cast<std::size_t>(c)];
    for (int y = 0; y < sample.height(); ++y) {
      std::ranges::transform(sample.row(c, y), result.row(c, y).begin(),
                             [m](float value) { return static_cast<float>(value - m); });
    }
  }
  return result;
}

bool on_own_torus(const Target& target, const Domain& domain) {
  return domain.periodic && domain.size == target.covariance.grid;
}

void require_unit_step(const Domain& domain) {
  if (domain.step != 1) {
    throw std::invalid_argument(
        fmt::format("samples with a step of {} pixels: expected 1, the step at which lags are measured", domain.step));
  }
}

}  // namespace textonbench
