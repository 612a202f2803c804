#include "methods/spot/texton_mix.h"

#include <cmath>
#include <vector>

namespace textonbench {
namespace {

/// Coefficients of a function of the angle a: constant + cosine cos 4a + sine sin 4a.
struct Harmonic {
  double cosine = 0;
  double sine = 0;
};

/// Rotating (g, h) to (g cos a + h sin a, h cos a − g sin a) changes Σ g⁴ + Σ h⁴ by this function.
Harmonic fourth_powers(std::span<const double> g, std::span<const double> h) {
  Harmonic result;
  for (std::size_t i = 0; i < g.size(); ++i) {
    const double gg = g[i] * g[i];
    const double hh = h[i] * h[i];
    result.cosine += (gg * gg + hh * hh) / 4 - 1.5 * gg * hh;
    result.sine += g[i] * h[i] * (gg - hh);
  }
  return result;
}

/// The same for (Σ g²)² + (Σ h²)².
Harmonic squared_energies(std::span<const double> g, std::span<const double> h) {
  double difference = 0;
  double product = 0;
  for (std::size_t i = 0; i < g.size(); ++i) {
    difference += g[i] * g[i] - h[i] * h[i];
    product += g[i] * h[i];
  }
  return {(difference * difference - 4 * product * product) / 4, difference * product};
}

void rotate(double angle, std::span<double> g, std::span<double> h) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  for (std::size_t i = 0; i < g.size(); ++i) {
    const double old = g[i];
    g[i] = c * old + s * h[i];
    h[i] = c * h[i] - s * old;
  }
}

double energy(std::span<const double> values) {
  double sum = 0;
  for (const double v : values) {
    sum += v * v;
  }
  return sum;
}

}  // namespace

void mix_textons(std::span<double> kernels, int count, int channels) {
  const std::size_t size = kernels.size() / static_cast<std::size_t>(count);
  const std::size_t plane = size / static_cast<std::size_t>(channels);
  const auto kernel = [&](int k) { return kernels.subspan(static_cast<std::size_t>(k) * size, size); };

  // κ_c is its fourth powers times a weight that rotations leave as it is; energies weigh more and more against it.
  std::vector<double> weights(static_cast<std::size_t>(channels));
  for (int c = 0; c < channels; ++c) {
    double squares = 0;
    for (int k = 0; k < count; ++k) {
      squares += energy(kernel(k).subspan(static_cast<std::size_t>(c) * plane, plane));
    }
    weights[static_cast<std::size_t>(c)] =
        squares > 0 ? static_cast<double>(plane) * static_cast<double>(count) / (squares * squares) : 0;
  }
  const double total = energy(kernels);
  if (total == 0) {
    return;
  }
  constexpr int sweeps = 48;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    // The last sweeps see energies only, and move what the kurtosis still pulled apart.
    const double of_kurtosis = sweep < sweeps - 24 ? std::pow(0.5, sweep) : 0;
    for (int k = 1; k < count; ++k) {
      for (int j = 0; j < k; ++j) {
        const Harmonic energies = squared_energies(kernel(j), kernel(k));
        const double weight = static_cast<double>(count) / (total * total);
        Harmonic sum{weight * energies.cosine, weight * energies.sine};
        for (int c = 0; c < channels && of_kurtosis > 0; ++c) {
          const std::size_t first = static_cast<std::size_t>(c) * plane;
          const Harmonic fourths = fourth_powers(kernel(j).subspan(first, plane), kernel(k).subspan(first, plane));
          sum.cosine += of_kurtosis * weights[static_cast<std::size_t>(c)] * fourths.cosine;
          sum.sine += of_kurtosis * weights[static_cast<std::size_t>(c)] * fourths.sine;
        }
        // cos(4a − φ) is least at 4a = φ + π; of the four equal minima the one nearest to no rotation is taken.
        rotate(std::atan2(-sum.sine, -sum.cosine) / 4, kernel(j), kernel(k));
      }
    }
  }
}

}  // namespace textonbench
