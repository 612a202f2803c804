#include "experiments/metrics/model_error.h"

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <vector>

#include "methods/base/welch.h"

namespace textonbench {
namespace {

template <class Error>
std::optional<double> compare(const Model& model, const Target& target, const Error& error) {
  const Gaussian* gaussian = model.gaussian();
  if (gaussian == nullptr) return std::nullopt;
  const CrossSpectrum& wanted = target.gaussian.spectrum;
  return error(gaussian->spectrum(wanted.grid()), wanted);
}

/// Hann's taper correlated with itself, over its energy.
std::vector<double> lag_window(int side) {
  std::vector<double> taper, window;
  for (int i = 0; i < side; ++i) taper.push_back(std::pow(std::sin(std::numbers::pi * (i + 0.5) / side), 2));
  for (int lag = 0; lag < side; ++lag) {
    double sum = 0;
    for (int i = lag; i < side; ++i)
      sum += taper[static_cast<std::size_t>(i)] * taper[static_cast<std::size_t>(i - lag)];
    window.push_back(sum / (0.375 * side));  // Σ sin⁴ = 3/8 side
  }
  return window;
}

/// Σ_v r(v) Γ(v) exp(−2πi k·v / T) on a torus of T x T.
CrossSpectrum smoothed(const CrossSpectrum& p, int side) {
  const Autocovariance covariance = autocovariance(p);
  const std::vector<double> window = lag_window(side);
  std::vector<Spectrum> products;
  for (int c = 0; c < p.channels(); ++c) {
    for (int d = 0; d <= c; ++d) {
      Image lags({side, side}, 1);
      for (int y = 1 - side; y < side; ++y) {
        for (int x = 1 - side; x < side; ++x) {
          const double r =
              window[static_cast<std::size_t>(std::abs(x))] * window[static_cast<std::size_t>(std::abs(y))];
          lags.at(0, (x + side) % side, (y + side) % side) += static_cast<float>(r * covariance.at(c, d, x, y));
        }
      }
      products.push_back(forward_fft(lags));
    }
  }
  return factor_products(products, p.channels());
}

}  // namespace

std::optional<double> smoothed_rme(const Model& model, const Target& target, const Domain&) {
  return compare(model, target, [](const CrossSpectrum& p, const CrossSpectrum& q) -> std::optional<double> {
    const int side = welch_side(q.grid());
    if (side < 2) return std::nullopt;
    return relative_model_error(smoothed(p, side), smoothed(q, side));
  });
}

std::optional<double> rme(const Model& model, const Target& target, const Domain&) {
  return compare(model, target, relative_model_error);
}

std::optional<double> rme_printed(const Model& model, const Target& target, const Domain&) {
  return compare(model, target, relative_model_error_as_printed);
}

std::optional<double> ot_distance(const Model& model, const Target& target, const Domain&) {
  return compare(model, target, [](const CrossSpectrum& p, const CrossSpectrum& q) {
    return std::sqrt(transport_distance_squared(p, q));
  });
}

}  // namespace textonbench
