#include "experiments/metrics/lrp_identities.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "methods/sparse/lrp.h"
#include "methods/sparse/wave_points.h"
#include "methods/sparse/wave_spectrum.h"

namespace textonbench {
namespace {

/// What the nine windows around a point add up to.
struct WindowSums {
  int windows = 0;
  double sum = 0;
  double squares = 0;
};

/// At the middles of 64 x 64 parts of a cell.
std::vector<WindowSums> sums_over_cell(LrpWindow window) {
  constexpr int parts = 64;
  std::vector<WindowSums> all;
  all.reserve(std::size_t{parts} * parts);
  for (int j = 0; j < parts; ++j) {
    for (int i = 0; i < parts; ++i) {
      WindowSums& here = all.emplace_back();
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const double w = lrp_window(window, std::hypot((i + 0.5) / parts - 0.5 - dx, (j + 0.5) / parts - 0.5 - dy));
          here.windows += w > 0 ? 1 : 0;
          here.sum += w;
          here.squares += w * w;
        }
      }
    }
  }
  return all;
}

double ripple(const std::vector<WindowSums>& all, double WindowSums::*value) {
  const auto [least, most] = std::ranges::minmax(all, {}, value);
  double mean = 0;
  for (const WindowSums& one : all) mean += one.*value / static_cast<double>(all.size());
  return (most.*value - least.*value) / mean;
}

/// Samples of a function on [−1.5, 1.5], its right half, with its Fourier transform.
class EvenWindow {
 public:
  template <class Function>
  explicit EvenWindow(const Function& function) : values_(nodes) {
    for (int i = 0; i < nodes; ++i) values_[static_cast<std::size_t>(i)] = function(i * step);
  }

  double transform(double frequency) const {
    double sum = 0.5 * values_.front();
    for (int i = 1; i < nodes; ++i) {
      sum += values_[static_cast<std::size_t>(i)] * std::cos(2 * std::numbers::pi * frequency * i * step);
    }
    return 2 * step * sum;
  }

  /// ∫_0^∞ |ŵ|² = ∫_0^1.5 w².
  double energy() const {
    double sum = 0.5 * values_.front() * values_.front();
    for (int i = 1; i < nodes; ++i) sum += values_[static_cast<std::size_t>(i)] * values_[static_cast<std::size_t>(i)];
    return step * sum;
  }

  double energy_within(double frequency) const {
    constexpr int parts = 400;
    double sum = 0;
    for (int i = 0; i <= parts; ++i) {
      sum += (i == 0 || i == parts ? 0.5 : 1) * std::pow(transform(frequency * i / parts), 2);
    }
    return sum * frequency / parts;
  }

  /// Radius that holds 75 % of the energy.
  double energy_radius() const {
    double low = 0, high = 2;
    for (int i = 0; i < 40; ++i) {
      const double middle = (low + high) / 2;
      (energy_within(middle) < 0.75 * energy() ? low : high) = middle;
    }
    return high;
  }

  /// The first zero of the transform.
  double main_lobe() const {
    double at = 0;
    while (transform(at) > 0) at += 1e-3;
    return at;
  }

 private:
  static constexpr int nodes = 768;
  static constexpr double step = 1.5 / nodes;
  std::vector<double> values_;
};

EvenWindow bessel_window() {
  return EvenWindow([](double y) { return lrp_window(LrpWindow::bessel, y); });
}

EvenWindow cut_gaussian(double deviation) {
  return EvenWindow([deviation](double y) { return std::exp(-y * y / (2 * deviation * deviation)); });
}

/// A field of one bin in windows of a width.
WaveField field_of_one_bin(LrpWindow window, double pixels) {
  WaveField field{.channels = 1, .side_bits = 8, .window = window, .even_variance = false, .layers = {}};
  WaveLayer& layer = field.layers.emplace_back();
  layer.spacing = std::llround(pixels * static_cast<double>(std::int64_t{1} << plane_bits));
  layer.first = {0, 1};
  layer.bins = {{64, 0}};
  layer.chance = {0xFFFFFFFFU};
  layer.color = {1};
  return field;
}

/// Radius around the frequency 1/4 that holds 75 % of the energy of the half plane.
double leakage_radius(LrpWindow window, double pixels) {
  constexpr int side = 256;
  const CrossSpectrum p = wave_spectrum(field_of_one_bin(window, pixels), {side, side});
  std::vector<std::pair<double, double>> bins;
  double total = 0;
  for (int ky = 0; ky < side; ++ky) {
    for (int kx = 1; kx < side / 2; ++kx) {
      const double power = std::norm(std::complex<double>(p.factors.front().at(0, kx, ky)));
      bins.emplace_back(std::hypot(kx - side / 4, ky < side / 2 ? ky : ky - side), power);
      total += power;
    }
  }
  std::ranges::sort(bins);
  double within = 0, last = 0;
  for (std::size_t i = 0; i < bins.size();) {
    // Bins of one radius together; between radii the energy is taken to grow evenly.
    const double radius = bins[i].first, before = within;
    for (; i < bins.size() && bins[i].first == radius; ++i) within += bins[i].second;
    if (within >= 0.75 * total) return last + (radius - last) * (0.75 * total - before) / (within - before);
    last = radius;
  }
  return last;
}

}  // namespace

std::optional<double> lrp_least_windows(const Model& model, const Target&, const Domain&) {
  const LrpAnalysis* lrp = lrp_analysis_of(model);
  if (lrp == nullptr) return std::nullopt;
  return std::ranges::min(sums_over_cell(lrp->field.window), {}, &WindowSums::windows).windows;
}

std::optional<double> lrp_most_windows(const Model& model, const Target&, const Domain&) {
  const LrpAnalysis* lrp = lrp_analysis_of(model);
  if (lrp == nullptr) return std::nullopt;
  return std::ranges::max(sums_over_cell(lrp->field.window), {}, &WindowSums::windows).windows;
}

std::optional<double> lrp_envelope_ripple(const Model& model, const Target&, const Domain&) {
  const LrpAnalysis* lrp = lrp_analysis_of(model);
  if (lrp == nullptr) return std::nullopt;
  return ripple(sums_over_cell(lrp->field.window), &WindowSums::sum);
}

std::optional<double> lrp_variance_ripple(const Model& model, const Target&, const Domain&) {
  const LrpAnalysis* lrp = lrp_analysis_of(model);
  if (lrp == nullptr) return std::nullopt;
  std::vector<WindowSums> all = sums_over_cell(lrp->field.window);
  if (lrp->field.even_variance) {
    for (WindowSums& one : all) one.squares /= one.squares;
  }
  return ripple(all, &WindowSums::squares);
}

std::optional<double> lrp_leakage_exponent(const Model& model, const Target&, const Domain&) {
  const LrpAnalysis* lrp = lrp_analysis_of(model);
  if (lrp == nullptr) return std::nullopt;
  return std::log2(leakage_radius(lrp->field.window, 12) / leakage_radius(lrp->field.window, 6));
}

std::optional<double> lrp_window_error(const Model& model, const Target&, const Domain&) {
  const LrpAnalysis* lrp = lrp_analysis_of(model);
  if (lrp == nullptr) return std::nullopt;
  double most = 0;
  for (int i = 0; i <= 1500; ++i) {
    const double y = 1e-3 * i;
    most = std::max(most, std::abs(lrp_window(lrp->field.window, y) - lrp_window(LrpWindow::bessel, y)));
  }
  return most;
}

std::optional<double> lrp_five_terms_error(const Model& model, const Target&, const Domain&) {
  if (lrp_analysis_of(model) == nullptr) return std::nullopt;
  const auto five_terms = [](double z) {
    double sum = 0;
    for (int m = 0; m <= 4; ++m) sum += std::pow(z / 2, 2 * m + 3) / (std::tgamma(m + 1) * std::tgamma(m + 4));
    return sum;
  };
  double most = 0;
  for (int i = 0; i <= 1500; ++i) {
    const double y = 1e-3 * i;
    const double z = 3 * std::numbers::pi * std::sqrt(1 - y * y / 2.25);
    most =
        std::max(most, std::abs(five_terms(z) / five_terms(3 * std::numbers::pi) - lrp_window(LrpWindow::bessel, y)));
  }
  return most;
}

std::optional<double> lrp_concentration_ratio(const Model& model, const Target&, const Domain&) {
  if (lrp_analysis_of(model) == nullptr) return std::nullopt;
  const EvenWindow bessel = bessel_window();
  const double radius = bessel.energy_radius();
  double low = 0.1, high = 2;
  for (int i = 0; i < 40; ++i) {
    const double middle = (low + high) / 2;
    (cut_gaussian(middle).energy_within(radius) < 0.75 * cut_gaussian(middle).energy() ? low : high) = middle;
  }
  const EvenWindow gaussian = cut_gaussian(high);
  const double lobe = bessel.main_lobe();
  return (1 - bessel.energy_within(lobe) / bessel.energy()) / (1 - gaussian.energy_within(lobe) / gaussian.energy());
}

std::optional<double> lrp_radial_energy(const Model& model, const Target&, const Domain&) {
  const LrpAnalysis* lrp = lrp_analysis_of(model);
  return lrp == nullptr ? std::nullopt : std::optional(lrp_window_moments(lrp->field.window).radial_energy);
}

std::optional<double> lrp_stratum_variance_error(const Model& model, const Target&, const Domain&) {
  const LrpAnalysis* lrp = lrp_analysis_of(model);
  if (lrp == nullptr) return std::nullopt;
  const WindowCorrelation correlation(lrp->field.window, lrp->field.even_variance);
  double most = 0;
  for (std::size_t i = 0; i < lrp->layers.size(); ++i) {
    const WaveLayer& layer = lrp->field.layers[i];
    double squares = 0;  // the colors of a wave are of one length
    for (int j = 0; j < layer.waves(); ++j) {
      const std::size_t entry =
          std::size_t{layer.first[static_cast<std::size_t>(j)]} * static_cast<std::size_t>(layer.colors);
      for (int c = 0; c < lrp->field.channels; ++c) {
        const std::size_t at = entry * static_cast<std::size_t>(lrp->field.channels) + static_cast<std::size_t>(c);
        squares += static_cast<double>(std::norm(layer.color[at]));
      }
    }
    const double variance = 0.5 * squares * correlation.at(0, 0);
    const double wanted = lrp->layers[i].stratum.energy / std::pow(lrp->spectrum.side(), 2);
    most = std::max(most, std::abs(variance / wanted - 1));
  }
  return most;
}

std::optional<double> lrp_strata_imbalance(const Model& model, const Target&, const Domain&) {
  const LrpAnalysis* lrp = lrp_analysis_of(model);
  if (lrp == nullptr) return std::nullopt;
  double total = 0, largest_bin = 0;
  for (const LrpLayer& layer : lrp->layers) total += layer.stratum.energy;
  const double share = total / static_cast<double>(lrp->layers.size());
  for (const Pixel& bin : lrp->layers.front().stratum.bins) {
    const int ky = bin.y < 0 ? bin.y + lrp->spectrum.side() : bin.y;
    largest_bin = std::max(largest_bin, 2 * lrp->spectrum.power(bin.x, ky));
  }
  double most = 0;
  for (const LrpLayer& layer : lrp->layers) most = std::max(most, std::abs(layer.stratum.energy - share) / largest_bin);
  return most;
}

std::optional<double> lrp_erosion_energy(const Model& model, const Target&, const Domain&) {
  const LrpAnalysis* lrp = lrp_analysis_of(model);
  if (lrp == nullptr) return std::nullopt;
  const EvenWindow window([&](double y) { return lrp_window(lrp->field.window, y); });
  return window.energy_within(lrp_window_moments(lrp->field.window).energy_radius) / window.energy();
}

std::optional<double> lrp_coverage(const Model& model, const Target&, const Domain&) {
  const LrpAnalysis* lrp = lrp_analysis_of(model);
  if (lrp == nullptr) return std::nullopt;
  // ∫|Ŵ|² / |Ŵ(0)|² of the window in the plane, 1 / spacing²: 2π ∫ r w² over (2π ∫ r w)².
  double mass = 0;
  constexpr int nodes = 3000;
  for (int i = 1; i < nodes; ++i)
    mass += 1.5 / nodes * (1.5 * i / nodes) * lrp_window(lrp->field.window, 1.5 * i / nodes);
  const double area = lrp_window_moments(lrp->field.window).radial_energy / (2 * std::numbers::pi * mass * mass);
  double sum = 0;
  for (const LrpLayer& layer : lrp->layers) {
    const double windows = layer.stratum.cosines * area * std::pow(lrp->spectrum.side() / layer.stratum.spacing, 2);
    sum += windows / (0.5 * layer.stratum.area) / static_cast<double>(lrp->layers.size());
  }
  return sum;
}

std::optional<double> lrp_calls(const Model& model, const Target&, const Domain&) {
  const LrpAnalysis* lrp = lrp_analysis_of(model);
  if (lrp == nullptr) return std::nullopt;
  std::vector<WavePoint> points;
  for (std::int64_t i = 0; i < 64; ++i) points.push_back({(i * 37) << plane_bits, (i * i * 5) << (plane_bits - 1)});
  std::vector<float> out(points.size() * static_cast<std::size_t>(lrp->field.channels));
  WaveCounts counts;
  sum_waves(lrp->field, Seed{1}, points, false, out, &counts);
  return static_cast<double>(counts.windows + counts.cosines) / static_cast<double>(points.size());
}

std::optional<double> lrp_calls_ratio(const Model& model, const Target& target, const Domain& domain) {
  const std::optional<double> calls = lrp_calls(model, target, domain);
  if (!calls) return std::nullopt;
  double cosines = 0;
  const LrpAnalysis& lrp = *lrp_analysis_of(model);
  for (const LrpLayer& layer : lrp.layers) cosines += layer.stratum.cosines;
  return *calls / (9 * (cosines + static_cast<double>(lrp.layers.size())));
}

}  // namespace textonbench
