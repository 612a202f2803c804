#include "methods/sparse/gabor_spectrum.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "methods/base/fft.h"
#include "methods/base/parallel.h"

namespace textonbench {
namespace {

std::size_t color_pair(int c, int d) {
  return static_cast<std::size_t>(c) * (static_cast<std::size_t>(c) + 1) / 2 + static_cast<std::size_t>(d);
}

std::vector<double> entry_chances(const GaborBand& band) {
  std::vector<double> all;
  all.reserve(band.chance.size());
  double before = 0;
  for (std::size_t e = 0; e < band.chance.size(); ++e) {
    const double upto = e + 1 == band.chance.size() ? 1 : static_cast<double>(band.chance[e]) * 0x1p-32;
    all.push_back(upto - before);
    before = upto;
  }
  return all;
}

/// κ_e / ρ(0) with the sign of the phase.
std::vector<double> phase_imbalances(const GaborField& field, const GaborBand& band) {
  std::vector<double> all(band.frequency.size());
  if (field.phase == GaborPhase::random) return all;
  const double sign = field.phase == GaborPhase::cosine ? 1 : -1, energy = gabor_energy(band);
  for (std::size_t e = 0; e < all.size(); ++e) all[e] = sign * gabor_imbalance(band, band.frequency[e]) / energy;
  return all;
}

/// Sums Γ_cd(v) of a band, d <= c, to `covariance`.
class BandCovariance {
 public:
  BandCovariance(const GaborField& field, const GaborBand& band)
      : channels_(field.channels),
        band_(band),
        chance_(entry_chances(band)),
        imbalance_(phase_imbalances(field, band)),
        scale_(0.5 * band.intensity * field.weight_power()) {}

  void add(int x, int y, double window, std::vector<double>& covariance) const {
    for (std::size_t e = 0; e < chance_.size(); ++e) {
      const GaborFrequency& f = band_.frequency[e];
      const std::complex<double> wave = std::polar(1.0, 2 * std::numbers::pi * (f.x * x + f.y * y));
      const double weight = scale_ * window * chance_[e];
      const std::complex<float>* color = band_.color.data() + e * static_cast<std::size_t>(channels_);
      for (int c = 0; c < channels_; ++c) {
        const std::complex<double> one(color[c]);
        for (int d = 0; d <= c; ++d) {
          const std::complex<double> other(color[d]);
          covariance[color_pair(c, d)] +=
              weight * ((one * std::conj(other) * wave).real() + imbalance_[e] * (one * other).real());
        }
      }
    }
  }

 private:
  int channels_;
  const GaborBand& band_;
  std::vector<double> chance_, imbalance_;
  double scale_;
};

}  // namespace

double gabor_window_correlation(const GaborBand& band, double distance) {
  const double half = distance / 2, reach = band.radius - half;
  if (reach <= 0) return 0;
  // Both windows are 1 within the lens |u| + s/2 <= sqrt(R² − v²), u along the lag and v across it.
  constexpr int nodes = 256;
  const double a = band.bandwidth;
  double sum = 0;
  for (int i = 0; i <= nodes; ++i) {
    const double u = reach * i / nodes;
    const double across = std::sqrt(std::max(0.0, band.radius * band.radius - (u + half) * (u + half)));
    const double weight = i == 0 || i == nodes ? 1 : i % 2 == 1 ? 4 : 2;
    sum += weight * std::exp(-2 * std::numbers::pi * a * a * u * u) *
           std::erf(std::sqrt(2 * std::numbers::pi) * a * across);
  }
  const double integral = 2 * sum * reach / (3 * nodes) / (std::numbers::sqrt2 * a);
  return std::exp(-std::numbers::pi * a * a * distance * distance / 2) * integral;
}

Eigen::MatrixXd gabor_covariance(const GaborField& field) {
  std::vector<double> pairs(color_pair(field.channels, 0));
  for (const GaborBand& band : field.bands) BandCovariance(field, band).add(0, 0, gabor_energy(band), pairs);
  Eigen::MatrixXd covariance(field.channels, field.channels);
  for (int c = 0; c < field.channels; ++c) {
    for (int d = 0; d <= c; ++d) covariance(c, d) = covariance(d, c) = pairs[color_pair(c, d)];
  }
  return covariance;
}

CrossSpectrum gabor_spectrum(const GaborField& field, Extent grid) {
  std::vector<Image> covariance;
  for (std::size_t pair = 0; pair < color_pair(field.channels, 0); ++pair) covariance.emplace_back(grid, 1);
  const auto wrap = [](int i, int n) { return (i % n + n) % n; };
  for (const GaborBand& band : field.bands) {
    const BandCovariance sum(field, band);
    const int reach = static_cast<int>(std::ceil(2 * band.radius));
    // Lags that fall on one row of the grid are summed by one thread.
    parallel_for(grid.height, [&](int row) {
      std::vector<double> pairs(covariance.size());
      for (int y = -reach + wrap(row + reach, grid.height); y <= reach; y += grid.height) {
        for (int x = -reach; x <= reach; ++x) {
          const double window = gabor_window_correlation(band, std::hypot(x, y));
          if (window <= 0) continue;
          std::ranges::fill(pairs, 0.0);
          sum.add(x, y, window, pairs);
          for (std::size_t pair = 0; pair < pairs.size(); ++pair) {
            covariance[pair].at(0, wrap(x, grid.width), row) += static_cast<float>(pairs[pair]);
          }
        }
      }
    });
  }
  std::vector<Spectrum> products;
  products.reserve(covariance.size());
  for (const Image& plane : covariance) products.push_back(forward_fft(plane));
  return factor_products(products, field.channels);
}

}  // namespace textonbench
