#include "experiments/metrics/border_cross.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <vector>

#include "methods/base/spectrum.h"

namespace textonbench {
namespace {

constexpr int smallest_side = 32;

enum class Border { torus, open };

double laplacian(const Image& u, int c, int x, int y, Border border) {
  constexpr int steps[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
  double sum = 0;
  for (const auto& step : steps) {
    int nx = x + step[0], ny = y + step[1];
    const bool outside = nx < 0 || ny < 0 || nx >= u.width() || ny >= u.height();
    if (outside && border == Border::open) continue;
    nx = (nx + u.width()) % u.width();
    ny = (ny + u.height()) % u.height();
    sum += static_cast<double>(u.at(c, nx, ny)) - static_cast<double>(u.at(c, x, y));
  }
  return sum;
}

/// tr P at any frequency, negative ones too.
class Power {
 public:
  explicit Power(const CrossSpectrum& law) : law_(law) {}
  double operator()(int kx, int ky) const {
    const Extent grid = law_.grid();
    kx = ((kx % grid.width) + grid.width) % grid.width;
    ky = ((ky % grid.height) + grid.height) % grid.height;
    if (kx > grid.width / 2) {
      kx = grid.width - kx;
      ky = (grid.height - ky) % grid.height;
    }
    double sum = 0;
    for (const Spectrum& factor : law_.factors) {
      for (int c = 0; c < factor.channels(); ++c) sum += std::norm(std::complex<double>(factor.at(c, kx, ky)));
    }
    return sum;
  }

 private:
  const CrossSpectrum& law_;
};

/// The model's power as a function of (frequency along an axis, frequency across it), for both axes in turn.
using AxisPower = std::function<double(int along, int across)>;

template <class Visit>
void for_each_axis(const CrossSpectrum& law, const Visit& visit) {
  const Power power(law);
  visit(law.grid().width, [&](int along, int across) { return power(along, across); });
  visit(law.grid().height, [&](int along, int across) { return power(across, along); });
}

std::optional<CrossSpectrum> law_of(const Model& model, const Target& target) {
  const Extent extent = target.exemplar.pixels.extent();
  const Gaussian* gaussian = model.gaussian();
  if (gaussian == nullptr || std::min(extent.width, extent.height) < smallest_side) return std::nullopt;
  return gaussian->spectrum(extent);
}

/// Law whose power is the periodogram of u under a Hann window.
CrossSpectrum hann_periodogram(const Image& u) {
  const auto hann = [](int i, int n) { return std::pow(std::sin(std::numbers::pi * (i + 0.5) / n), 2); };
  const std::vector<double> mean = channel_means(u);
  // Σ w² over a side of n pixels is 3n/8.
  const double scale = 1 / std::sqrt(9.0 / 64 * static_cast<double>(u.extent().area()));
  Image windowed(u.extent(), u.channels());
  for (int c = 0; c < u.channels(); ++c) {
    for (int y = 0; y < u.height(); ++y) {
      for (int x = 0; x < u.width(); ++x) {
        const double difference = static_cast<double>(u.at(c, x, y)) - mean[static_cast<std::size_t>(c)];
        windowed.at(c, x, y) = static_cast<float>(scale * hann(x, u.width()) * hann(y, u.height()) * difference);
      }
    }
  }
  CrossSpectrum law;
  law.factors.push_back(forward_fft(windowed));
  return law;
}

/// Sums over the half-octave bands [4 · 2^{j/2}, 4 · 2^{(j+1)/2}) of both axes that lie below the Nyquist frequency.
std::vector<double> band_powers(const CrossSpectrum& law, const std::function<double(const AxisPower&, int)>& at) {
  std::vector<double> bands;
  for_each_axis(law, [&](int side, const AxisPower& power) {
    int k = 4;
    for (int j = 1; 4 * std::pow(2, j / 2.0) <= side / 2.0; ++j) {
      double sum = 0;
      for (; k < 4 * std::pow(2, j / 2.0); ++k) sum += at(power, k);
      bands.push_back(sum);
    }
  });
  return bands;
}

}  // namespace

std::optional<double> periodic_laplacian_error(const Model&, const Target& target, const Domain&) {
  const Image& u = target.exemplar.pixels;
  const Image& p = target.periodic_component;
  double largest = 0, error = 0;
  for (int c = 0; c < u.channels(); ++c) {
    const auto channel = static_cast<std::size_t>(c);
    error = std::max(error, std::fabs(channel_means(p)[channel] - channel_means(u)[channel]));
    for (int y = 0; y < u.height(); ++y) {
      for (int x = 0; x < u.width(); ++x) {
        const double wanted = laplacian(u, c, x, y, Border::open);
        largest = std::max(largest, std::fabs(wanted));
        error = std::max(error, std::fabs(laplacian(p, c, x, y, Border::torus) - wanted));
      }
    }
  }
  return largest > 0 ? std::optional(error / largest) : std::nullopt;
}

std::optional<double> axis_energy_ratio(const Model& model, const Target& target, const Domain&) {
  const std::optional<CrossSpectrum> law = law_of(model, target);
  if (!law) return std::nullopt;
  double on_axes = 0, beside = 0;
  for_each_axis(*law, [&](int side, const AxisPower& power) {
    for (int k = 8; 2 * k < side; ++k) {
      on_axes += power(k, 0);
      for (int across = 4; across <= 8; ++across) beside += (power(k, across) + power(k, -across)) / 10;
    }
  });
  return beside > 0 ? std::optional(on_axes / beside) : std::nullopt;
}

std::optional<double> axis_power_error(const Model& model, const Target& target, const Domain&) {
  const std::optional<CrossSpectrum> law = law_of(model, target);
  if (!law) return std::nullopt;
  const std::vector<double> found = band_powers(*law, [](const AxisPower& power, int k) {
    constexpr double weights[] = {1.0 / 6, 2.0 / 3, 1.0 / 6};
    double sum = 0;
    for (int a = -1; a <= 1; ++a) {
      for (int b = -1; b <= 1; ++b) sum += weights[a + 1] * weights[b + 1] * power(k + a, b);
    }
    return sum;
  });
  const std::vector<double> wanted =
      band_powers(hann_periodogram(target.exemplar.pixels), [](const AxisPower& power, int k) { return power(k, 0); });
  double decibels = 0;
  int bands = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i] <= 0 || wanted[i] <= 0) continue;
    decibels += std::fabs(10 * std::log10(found[i] / wanted[i]));
    ++bands;
  }
  return bands > 0 ? std::optional(decibels / bands) : std::nullopt;
}

}  // namespace textonbench
