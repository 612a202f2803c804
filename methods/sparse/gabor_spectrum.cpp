#include "methods/sparse/gabor_spectrum.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "methods/base/fft.h"
#include "methods/base/parallel.h"

namespace textonbench {
namespace {

int wrapped(int i, int n) { return (i % n + n) % n; }

/// Σ_e p_e κ_e / ρ(0) c_c c_d of a band for d <= c, κ with the sign of the phase.
std::vector<double> phase_imbalance(const GaborField& field, const GaborBand& band) {
  std::vector<double> pairs(color_pair_of(field.channels, 0));
  if (field.phase == GaborPhase::random) return pairs;
  const double sign = field.phase == GaborPhase::cosine ? 1 : -1, energy = band.window.energy();
  const std::vector<double> chance = band.chances();
  for (std::size_t e = 0; e < chance.size(); ++e) {
    const double weight = sign * chance[e] * gabor_imbalance(band.window, band.frequency[e]) / energy;
    const std::complex<float>* color = band.color.data() + e * static_cast<std::size_t>(field.channels);
    for (int c = 0; c < field.channels; ++c) {
      for (int d = 0; d <= c; ++d) {
        pairs[color_pair_of(c, d)] += weight * (std::complex<double>(color[c]) * std::complex<double>(color[d])).real();
      }
    }
  }
  return pairs;
}

/// Σ_e p_e Re(c_c c_d* exp(2πi f_e · v)) of a band for d <= c, entry by entry.
class WavesByEntry {
 public:
  WavesByEntry(int channels, const GaborBand& band) : channels_(channels), band_(band), chance_(band.chances()) {}

  void add(int x, int y, double scale, std::vector<double>& pairs) const {
    for (std::size_t e = 0; e < chance_.size(); ++e) {
      const GaborFrequency& f = band_.frequency[e];
      const std::complex<double> wave = std::polar(scale * chance_[e], 2 * std::numbers::pi * (f.x * x + f.y * y));
      const std::complex<float>* color = band_.color.data() + e * static_cast<std::size_t>(channels_);
      for (int c = 0; c < channels_; ++c) {
        for (int d = 0; d <= c; ++d) {
          pairs[color_pair_of(c, d)] +=
              (std::complex<double>(color[c]) * std::conj(std::complex<double>(color[d])) * wave).real();
        }
      }
    }
  }

 private:
  int channels_;
  const GaborBand& band_;
  std::vector<double> chance_;
};

/// The same of entries that are bins of a raster, by a transform a pair of channels.
class WavesByTransform {
 public:
  WavesByTransform(int channels, const GaborBand& band) : raster_(band.raster) {
    const std::vector<double> chance = band.chances();
    for (int c = 0; c < channels; ++c) {
      for (int d = 0; d <= c; ++d) {
        Spectrum sum(raster_, 1);
        for (std::size_t e = 0; e < chance.size(); ++e) {
          const std::complex<float>* color = band.color.data() + e * static_cast<std::size_t>(channels);
          add_bin(band.frequency[e],
                  chance[e] * std::complex<double>(color[c]) * std::conj(std::complex<double>(color[d])), sum);
        }
        waves_.push_back(inverse_fft(sum));
      }
    }
  }

  void add(int x, int y, double scale, std::vector<double>& pairs) const {
    for (std::size_t pair = 0; pair < waves_.size(); ++pair) {
      pairs[pair] += scale * double{waves_[pair].at(0, wrapped(x, raster_.width), wrapped(y, raster_.height))};
    }
  }

 private:
  /// A wave Re(z exp(2πi f · v)).
  void add_bin(const GaborFrequency& f, const std::complex<double>& z, Spectrum& sum) const {
    const int kx = wrapped(static_cast<int>(std::lround(f.x * raster_.width)), raster_.width);
    const int ky = wrapped(static_cast<int>(std::lround(f.y * raster_.height)), raster_.height);
    const auto half = std::complex<float>(z * (0.5 * static_cast<double>(raster_.area())));
    const auto add_half = [&](int x, int y, const std::complex<float>& part) {
      if (x < sum.columns()) sum.row(0, y)[static_cast<std::size_t>(x)] += part;
    };
    add_half(kx, ky, half);
    add_half(wrapped(-kx, raster_.width), wrapped(-ky, raster_.height), std::conj(half));
  }

  Extent raster_;
  std::vector<Image> waves_;
};

/// Adds Γ_cd(v) of a band, lags modulo the size of the planes.
template <class Waves>
void add_band(const GaborField& field, const GaborBand& band, const Waves& waves, std::vector<Image>& covariance) {
  const Extent grid = covariance.front().extent();
  const GaborCorrelation correlation(band.window);
  const std::vector<double> imbalance = phase_imbalance(field, band);
  const double scale = 0.5 * band.intensity * field.weight_power();
  const int across = static_cast<int>(std::ceil(2 * band.window.half_width()));
  const int down = static_cast<int>(std::ceil(2 * band.window.half_height()));
  // Lags that fall on one row of the grid are summed by one thread.
  parallel_for(grid.height, [&](int row) {
    std::vector<double> pairs(covariance.size());
    for (int y = -down + wrapped(row + down, grid.height); y <= down; y += grid.height) {
      for (int x = -across; x <= across; ++x) {
        const double window = scale * correlation.at(x, y);
        if (window <= 0) continue;
        for (std::size_t pair = 0; pair < pairs.size(); ++pair) pairs[pair] = window * imbalance[pair];
        waves.add(x, y, window, pairs);
        for (std::size_t pair = 0; pair < pairs.size(); ++pair) {
          covariance[pair].at(0, wrapped(x, grid.width), row) += static_cast<float>(pairs[pair]);
        }
      }
    }
  });
}

/// ρ of the window exp(−π r²) cut at r = `reach`.
double round_correlation(double distance, double reach) {
  const double half = distance / 2, left = reach - half;
  if (left <= 0) return 0;
  // Both windows are 1 within the lens |u| + s/2 <= sqrt(R² − v²), u along the lag and v across it.
  constexpr int nodes = 256;
  double sum = 0;
  for (int i = 0; i <= nodes; ++i) {
    const double u = left * i / nodes;
    const double across = std::sqrt(std::max(0.0, reach * reach - (u + half) * (u + half)));
    const double weight = i == 0 || i == nodes ? 1 : i % 2 == 1 ? 4 : 2;
    sum += weight * std::exp(-2 * std::numbers::pi * u * u) * std::erf(std::sqrt(2 * std::numbers::pi) * across);
  }
  const double integral = 2 * sum * left / (3 * nodes) / std::numbers::sqrt2;
  return std::exp(-std::numbers::pi * distance * distance / 2) * integral;
}

}  // namespace

GaborCorrelation::GaborCorrelation(const GaborWindow& window)
    : window_(window), furthest_(2 * std::sqrt(window.limit())) {
  constexpr int steps = 1024;
  nodes_.reserve(steps + 2);
  const double scale = 1 / std::sqrt(window.determinant());
  for (int i = 0; i <= steps; ++i) nodes_.push_back(scale * round_correlation(furthest_ * i / steps, furthest_ / 2));
  nodes_.front() = window.energy();
  nodes_.push_back(0);
}

double GaborCorrelation::at(double x, double y) const {
  const double place = std::sqrt(window_.form(x, y)) / furthest_ * static_cast<double>(nodes_.size() - 2);
  if (place >= static_cast<double>(nodes_.size() - 2)) return 0;
  const auto node = static_cast<std::size_t>(place);
  return std::lerp(nodes_[node], nodes_[node + 1], place - static_cast<double>(node));
}

Eigen::MatrixXd gabor_covariance(const GaborField& field) {
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(field.channels, field.channels);
  for (const GaborBand& band : field.bands) {
    std::vector<double> pairs = phase_imbalance(field, band);
    WavesByEntry(field.channels, band).add(0, 0, 1, pairs);
    const double scale = 0.5 * band.intensity * field.weight_power() * band.window.energy();
    for (int c = 0; c < field.channels; ++c) {
      for (int d = 0; d <= c; ++d) covariance(c, d) += scale * pairs[color_pair_of(c, d)];
    }
  }
  return covariance.selfadjointView<Eigen::Lower>();
}

CrossSpectrum gabor_spectrum(const GaborField& field, Extent grid) {
  std::vector<Image> covariance;
  for (std::size_t pair = 0; pair < color_pair_of(field.channels, 0); ++pair) covariance.emplace_back(grid, 1);
  for (const GaborBand& band : field.bands) {
    if (band.raster.width > 0) {
      add_band(field, band, WavesByTransform(field.channels, band), covariance);
    } else {
      add_band(field, band, WavesByEntry(field.channels, band), covariance);
    }
  }
  std::vector<Spectrum> products;
  products.reserve(covariance.size());
  for (const Image& plane : covariance) products.push_back(forward_fft(plane));
  return factor_products(products, field.channels);
}

}  // namespace textonbench
