#include "methods/sparse/lrp_window.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace textonbench {
namespace {

/// Terms of the series in t: those of I_3 beyond are below 1e-13 of its value.
constexpr int series_terms = 22;
using Series = std::array<double, series_terms>;

/// c_m with b(3π sqrt(t)) / b(3π) = t^{3/2} Σ c_m t^m: (3π/2)^{2m} / (m! (m + order)!), divided by the sum.
Series series_of(LrpWindow window) {
  const int order = window == LrpWindow::bessel ? 3 : 2;
  const int terms = window == LrpWindow::bessel ? series_terms : 5;
  const double q = std::pow(1.5 * std::numbers::pi, 2);
  Series c{};
  double term = 1, sum = 0;
  for (int m = 0; m < terms; ++m) {
    c[static_cast<std::size_t>(m)] = term;
    sum += term;
    term *= q / ((m + 1) * (m + 1 + order));
  }
  for (double& value : c) value /= sum;
  return c;
}

const Series& series(LrpWindow window) {
  static const Series all[] = {series_of(LrpWindow::bessel), series_of(LrpWindow::printed)};
  return all[static_cast<int>(window)];
}

double value(const Series& c, double t) {
  double sum = 0;
  for (int m = series_terms - 1; m >= 0; --m) sum = sum * t + c[static_cast<std::size_t>(m)];
  return sum;
}

/// The polynomial through the series at the Chebyshev points of [0, 1] (divided differences, then powers of t).
std::array<float, lrp_window_terms> economized(LrpWindow window) {
  constexpr int n = lrp_window_terms;
  std::array<double, n> x{}, d{};
  for (int i = 0; i < n; ++i) {
    x[static_cast<std::size_t>(i)] = 0.5 + 0.5 * std::cos(std::numbers::pi * (i + 0.5) / n);
    d[static_cast<std::size_t>(i)] = value(series(window), x[static_cast<std::size_t>(i)]);
  }
  for (int k = 1; k < n; ++k) {
    for (int i = n - 1; i >= k; --i) {
      const auto at = static_cast<std::size_t>(i);
      d[at] = (d[at] - d[at - 1]) / (x[at] - x[at - static_cast<std::size_t>(k)]);
    }
  }
  std::array<double, n> power{};
  for (int i = n - 1; i >= 0; --i) {  // power = power (t − x_i) + d_i
    for (int m = n - 1; m > 0; --m) {
      const auto at = static_cast<std::size_t>(m);
      power[at] = power[at - 1] - power[at] * x[static_cast<std::size_t>(i)];
    }
    power[0] = d[static_cast<std::size_t>(i)] - power[0] * x[static_cast<std::size_t>(i)];
  }
  std::array<float, n> result{};
  for (std::size_t m = 0; m < n; ++m) result[m] = static_cast<float>(power[m]);
  return result;
}

LrpWindowMoments moments_of(LrpWindow window) {
  // Trapezoid sums: w vanishes with its derivative at ±1.5, and frequencies beyond 4 hold below 1e-6 of the energy.
  constexpr int nodes = 1536;
  constexpr double h = 1.5 / nodes, step = 1.0 / 256;
  std::vector<double> w(nodes);
  LrpWindowMoments moments;
  double energy = 0;
  for (int i = 0; i < nodes; ++i) {
    const double v = lrp_window(window, i * h);
    w[static_cast<std::size_t>(i)] = v * (i == 0 ? 0.5 : 1);
    moments.radial_energy += h * (i * h) * v * v;
    energy += h * v * v * (i == 0 ? 0.5 : 1);  // ∫_0^1.5 w² = ∫_0^∞ ŵ²
  }
  double within = 0, last = 0;
  for (int k = 0;; ++k) {
    double transform = 0;
    for (int i = 0; i < nodes; ++i) {
      transform += 2 * h * w[static_cast<std::size_t>(i)] * std::cos(2 * std::numbers::pi * k * step * i * h);
    }
    const double density = transform * transform;
    const double more = k == 0 ? 0 : 0.5 * step * (last + density);
    if (within + more >= 0.75 * energy) {
      moments.energy_radius = (k - 1 + (0.75 * energy - within) / more) * step;
      return moments;
    }
    within += more;
    last = density;
  }
}

}  // namespace

double lrp_window(LrpWindow window, double y) {
  const double t = 1 - y * y / 2.25;
  return t <= 0 ? 0 : t * std::sqrt(t) * value(series(window), t);
}

const std::array<float, lrp_window_terms>& lrp_window_polynomial(LrpWindow window) {
  static const std::array<float, lrp_window_terms> all[] = {economized(LrpWindow::bessel),
                                                            economized(LrpWindow::printed)};
  return all[static_cast<int>(window)];
}

const LrpWindowMoments& lrp_window_moments(LrpWindow window) {
  static const LrpWindowMoments all[] = {moments_of(LrpWindow::bessel), moments_of(LrpWindow::printed)};
  return all[static_cast<int>(window)];
}

}  // namespace textonbench
