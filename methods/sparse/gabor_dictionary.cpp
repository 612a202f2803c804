#include "methods/sparse/gabor_dictionary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "methods/base/parallel.h"
#include "methods/sparse/gabor_spectrum.h"

namespace textonbench {
namespace {

/// ρ(v) / ρ(0) at lags modulo the raster.
Image folded_correlation(Extent raster, const GaborWindow& window) {
  const GaborCorrelation correlation(window);
  const int across = static_cast<int>(std::ceil(2 * window.half_width()));
  const int down = static_cast<int>(std::ceil(2 * window.half_height()));
  const auto wrap = [](int i, int n) { return (i % n + n) % n; };
  Image folded(raster, 1);
  for (int y = -down; y <= down; ++y) {
    for (int x = -across; x <= across; ++x) {
      folded.at(0, wrap(x, raster.width), wrap(y, raster.height)) +=
          static_cast<float>(correlation.at(x, y) / window.energy());
    }
  }
  return folded;
}

/// bins *= factor, the columns that are stored.
void scale_bins(const Image& factor, std::span<std::complex<float>> bins, int y) {
  const auto row = factor.row(0, y);
  for (std::size_t x = 0; x < bins.size(); ++x) bins[x] *= row[x];
}

}  // namespace

GaborDictionary::GaborDictionary(Extent raster, std::span<const GaborWindow> windows) : raster_(raster) {
  if (windows.empty() || windows.size() > Image::max_channels) {
    throw std::invalid_argument(
        fmt::format("a dictionary of {} windows: expected 1 to {}", windows.size(), Image::max_channels));
  }
  for (const GaborWindow& window : windows) {
    if (window.xy != 0) throw std::invalid_argument("a dictionary of skewed windows: expected xy = 0");
    correlation_.push_back(folded_correlation(raster, window));
    double energy = 0;
    for (int y = 0; y < raster.height; ++y) {
      for (const float v : correlation_.back().row(0, y)) energy += double{v} * v;
    }
    norms_.push_back(std::sqrt(energy / static_cast<double>(raster.area())));
    // A power's variance is A / 4π.
    const auto whole = [](double bins) { return std::max(1, static_cast<int>(bins + 1e-6)); };
    spacing_.push_back({whole(raster.width * std::sqrt(window.xx / (4 * std::numbers::pi))),
                        whole(raster.height * std::sqrt(window.yy / (4 * std::numbers::pi)))});
  }
}

bool GaborDictionary::is_center(int band, int kx, int ky) const {
  const Extent apart = spacing_[static_cast<std::size_t>(band)];
  return std::min(kx, raster_.width - kx) % apart.width == 0 && std::min(ky, raster_.height - ky) % apart.height == 0;
}

// Images of frequencies are even, so that forward and inverse transforms to lags are the same but for their scale.

Image GaborDictionary::sum(const Image& coefficients) const {
  Spectrum lags = forward_fft(coefficients);
  Spectrum total(raster_, 1);
  parallel_for(raster_.height, [&](int y) {
    const auto to = total.row(0, y);
    for (int b = 0; b < bands(); ++b) {
      const auto from = lags.row(b, y);
      scale_bins(correlation_[static_cast<std::size_t>(b)], from, y);
      for (std::size_t x = 0; x < to.size(); ++x) to[x] += from[x];
    }
  });
  return inverse_fft(total);
}

Image GaborDictionary::correlate(const Image& residual) const {
  const Spectrum lags = forward_fft(residual);
  Spectrum all = Spectrum::uninitialized(raster_, bands());
  parallel_for(raster_.height, [&](int y) {
    const auto from = lags.row(0, y);
    for (int b = 0; b < bands(); ++b) {
      const auto to = all.row(b, y);
      std::ranges::copy(from, to.begin());
      scale_bins(correlation_[static_cast<std::size_t>(b)], to, y);
    }
  });
  return inverse_fft(all);
}

Spectrum GaborDictionary::correlate(const Spectrum& values, int band) const {
  Image lags = inverse_fft(values);
  const Image& factor = correlation_[static_cast<std::size_t>(band)];
  for (int y = 0; y < raster_.height; ++y) {
    const auto row = lags.row(0, y);
    const auto by = factor.row(0, y);
    for (std::size_t x = 0; x < row.size(); ++x) row[x] *= by[x];
  }
  return forward_fft(lags);
}

}  // namespace textonbench
