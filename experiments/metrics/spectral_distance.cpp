#include "experiments/metrics/spectral_distance.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <numeric>
#include <utility>

#include "experiments/metrics/target_law.h"

namespace textonbench {
namespace {

constexpr int orientations = 8;

/// Bin of every frequency of a half spectrum.
class FrequencyBins {
 public:
  explicit FrequencyBins(Extent raster) : raster_(raster), columns_(raster.width / 2 + 1) {
    const double innermost_radius = 2.0 / std::min(raster.width, raster.height);
    rings_ = 1 + std::max(0, ring(innermost_radius * innermost_radius));
    bins_.reserve(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(raster.height));
    for (int ky = 0; ky < raster.height; ++ky) {
      const double fy = static_cast<double>(2 * ky > raster.height ? ky - raster.height : ky) / raster.height;
      for (int kx = 0; kx < columns_; ++kx) {
        const double fx = static_cast<double>(kx) / raster.width;
        bins_.push_back(kx == 0 && ky == 0 ? none : static_cast<std::uint16_t>(bin(fx, fy)));
      }
    }
  }

  int count() const { return rings_ * orientations; }

  /// Sums power(kx, ky) over the full spectrum by bin.
  template <class Power>
  std::vector<double> sum(const Power& power) const {
    std::vector<double> sums(static_cast<std::size_t>(count()));
    const std::uint16_t* next = bins_.data();
    for (int ky = 0; ky < raster_.height; ++ky) {
      for (int kx = 0; kx < columns_; ++kx) {
        const std::uint16_t b = *next++;
        if (b == none) continue;
        const bool mirrored_bin_is_stored = kx == 0 || 2 * kx == raster_.width;
        sums[b] += (mirrored_bin_is_stored ? 1 : 2) * power(kx, ky);
      }
    }
    return sums;
  }

 private:
  static constexpr std::uint16_t none = 0xffff;

  /// Number of half octaves below √½, the largest radius there is.
  static int ring(double squared_radius) { return std::ilogb(0.5 / squared_radius); }

  int bin(double fx, double fy) const {
    const int r = std::min(ring(fx * fx + fy * fy), rings_ - 1);
    const auto sector = static_cast<int>(std::lround(std::atan2(fy, fx) * orientations / std::numbers::pi));
    return r * orientations + (sector + orientations) % orientations;
  }

  Extent raster_;
  int columns_;
  int rings_;
  std::vector<std::uint16_t> bins_;
};

/// Σ_c |û_c|² by bin.
std::vector<double> binned_power(const FrequencyBins& bins, const Spectrum& u) {
  std::vector<double> total(static_cast<std::size_t>(bins.count()));
  for (int c = 0; c < u.channels(); ++c) {
    const std::vector<double> one =
        bins.sum([&](int kx, int ky) { return static_cast<double>(std::norm(u.at(c, kx, ky))); });
    std::ranges::transform(total, one, total.begin(), std::plus<>());
  }
  return total;
}

std::vector<double> hann(int n) {
  std::vector<double> window;
  window.reserve(static_cast<std::size_t>(n));
  for (int x = 0; x < n; ++x) {
    const double s = std::sin(std::numbers::pi * (x + 0.5) / n);
    window.push_back(s * s);
  }
  return window;
}

/// (w ⋆ w)(v) / Σ w², v = 0 … n − 1.
std::vector<double> normalized_autocorrelation(const std::vector<double>& w) {
  std::vector<double> result;
  for (auto shifted = w.begin(); shifted != w.end(); ++shifted) {
    result.push_back(std::inner_product(shifted, w.end(), w.begin(), 0.0));
  }
  const double at_zero = result.front();
  for (double& r : result) r /= at_zero;
  return result;
}

/// tr Γ of the law on Z², lags modulo a torus that keeps |v_x| < size.width, |v_y| < size.height apart.
Image trace_covariance(const Target& target, Extent size) {
  const Extent spot = target.covariance.grid;
  const Spectrum t = spot_spectrum(target, {good_fft_size(spot.width + std::min(spot.width, size.width)),
                                            good_fft_size(spot.height + std::min(spot.height, size.height))});
  Spectrum power(t.raster(), 1);
  for (int c = 0; c < t.channels(); ++c) {
    for (int ky = 0; ky < t.rows(); ++ky) {
      std::ranges::transform(power.row(0, ky), t.row(c, ky), power.row(0, ky).begin(),
                             [](std::complex<float> sum, std::complex<float> bin) { return sum + std::norm(bin); });
    }
  }
  return inverse_fft(power);
}

/// Expectation of the windowed periodogram at the frequencies of a raster of that size: the transform of the windowed
/// covariance, lags folded modulo the raster.
std::vector<double> expected_windowed_power(const FrequencyBins& bins, const Target& target, Extent size) {
  const Image covariance = trace_covariance(target, size);
  const std::vector<double> rx = normalized_autocorrelation(hann(size.width));
  const std::vector<double> ry = normalized_autocorrelation(hann(size.height));
  const int reach_x = std::min(size.width, target.covariance.grid.width) - 1;
  const int reach_y = std::min(size.height, target.covariance.grid.height) - 1;
  Image folded(size, 1);
  for (int y = -reach_y; y <= reach_y; ++y) {
    const auto from = covariance.row(0, y < 0 ? y + covariance.height() : y);
    const auto to = folded.row(0, y < 0 ? y + size.height : y);
    for (int x = -reach_x; x <= reach_x; ++x) {
      const double windowed = ry[static_cast<std::size_t>(std::abs(y))] * rx[static_cast<std::size_t>(std::abs(x))] *
                              from[static_cast<std::size_t>(x < 0 ? x + covariance.width() : x)];
      to[static_cast<std::size_t>(x < 0 ? x + size.width : x)] += static_cast<float>(windowed);
    }
  }
  const Spectrum expected = forward_fft(folded);
  return bins.sum([&](int kx, int ky) { return static_cast<double>(expected.at(0, kx, ky).real()); });
}

class LogSpectralDistance : public SampleMetric {
 public:
  LogSpectralDistance(const Target& target, const Domain& domain) : mean_(target.gaussian.mean), bins_(domain.size) {
    require_unit_step(domain);
    if (!domain.periodic) {
      window_x_ = hann(domain.size.width);
      window_y_ = hann(domain.size.height);
    }
    wanted_ = domain.periodic ? binned_power(bins_, spot_spectrum(target, domain.size))
                              : expected_windowed_power(bins_, target, domain.size);
  }

  std::vector<float> statistic(const Image& sample, const Domain& domain) const override {
    Image u = centered(sample, mean_, sample.extent());
    auto norm = static_cast<double>(u.extent().area());
    if (!domain.periodic) norm = apply_window(u);
    const std::vector<double> power = binned_power(bins_, forward_fft(u));
    std::vector<float> result(power.size());
    std::ranges::transform(power, result.begin(), [norm](double sum) { return static_cast<float>(sum / norm); });
    return result;
  }

  double value(std::span<const double> power) const override {
    constexpr double least_share = 1e-3;
    constexpr double empty = 1e-10;  // −100 dB
    const double total = std::accumulate(wanted_.begin(), wanted_.end(), 0.0);
    double sum = 0;
    int looked_at = 0;
    for (std::size_t b = 0; b < wanted_.size(); ++b) {
      if (wanted_[b] < least_share * total) continue;
      sum += std::abs(10 * std::log10(std::max(power[b] / wanted_[b], empty)));
      ++looked_at;
    }
    return sum / looked_at;
  }

 private:
  /// Returns Σ w².
  double apply_window(Image& u) const {
    for (int c = 0; c < u.channels(); ++c) {
      for (int y = 0; y < u.height(); ++y) {
        const double wy = window_y_[static_cast<std::size_t>(y)];
        std::ranges::transform(u.row(c, y), window_x_, u.row(c, y).begin(),
                               [wy](float value, double wx) { return static_cast<float>(value * wx * wy); });
      }
    }
    return std::inner_product(window_x_.begin(), window_x_.end(), window_x_.begin(), 0.0) *
           std::inner_product(window_y_.begin(), window_y_.end(), window_y_.begin(), 0.0);
  }

  std::vector<double> mean_;
  FrequencyBins bins_;
  std::vector<double> window_x_, window_y_;
  std::vector<double> wanted_;
};

}  // namespace

std::unique_ptr<SampleMetric> log_spectral_distance(const Target& target, const Domain& domain, Seed) {
  return std::make_unique<LogSpectralDistance>(target, domain);
}

}  // namespace textonbench
