#include "experiments/metrics/lrp_estimates.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "methods/sparse/lrp.h"
#include "methods/sparse/lrp_suggestion.h"
#include "methods/sparse/wave_filter.h"
#include "methods/sparse/wave_points.h"
#include "methods/sparse/wave_raster.h"
#include "methods/sparse/wave_spectrum.h"

namespace textonbench {
namespace {

constexpr int footprint = 8;

/// Squared distance of an estimate from the known power, over that of zero.
double estimate_error(const WelchSpectrum& estimate, const CrossSpectrum& known) {
  double error = 0, power = 0;
  const int side = estimate.side();
  for (int ky = 0; ky < side; ++ky) {
    for (int kx = 0; kx <= side / 2; ++kx) {
      if (kx == 0 && ky == 0) continue;
      double p = 0;
      for (const Spectrum& factor : known.factors) p += std::norm(std::complex<double>(factor.at(0, kx, ky)));
      error += std::pow(estimate.power(kx, ky) - p, 2);
      power += p * p;
    }
  }
  return error / power;
}

/// Distance of `filtered` from means of `sharp` over pixels around 256 points, over the deviation of `sharp` from zero.
/// Both write the values of `channels` channels at points, channel after channel.
template <class Sharp, class Filtered>
double filter_error(int channels, const Sharp& sharp, const Filtered& filtered) {
  constexpr std::int64_t count = 256, fine = std::int64_t{2} * footprint;
  std::vector<WavePoint> centers, points;
  centers.reserve(count);
  points.reserve(static_cast<std::size_t>(count * fine * fine));
  for (std::int64_t i = 0; i < count; ++i) {
    const WavePoint center =
        centers.emplace_back(WavePoint{i * 37 * plane_pixel / 3, (i * i % 509) * 11 * plane_pixel / 2});
    for (std::int64_t k = 0; k < fine * fine; ++k) {
      points.push_back({center.x + (2 * (k % fine) + 1 - fine) * footprint * plane_pixel / (2 * fine),
                        center.y + (2 * (k / fine) + 1 - fine) * footprint * plane_pixel / (2 * fine)});
    }
  }
  const auto planes = static_cast<std::size_t>(channels);
  std::vector<float> fine_values(points.size() * planes), values(centers.size() * planes);
  sharp(points, fine_values);
  filtered(centers, values);
  double error = 0, power = 0;
  constexpr auto each = static_cast<std::size_t>(fine * fine);
  for (std::size_t i = 0; i < values.size(); ++i) {
    double mean = 0;
    for (const float v : std::span(fine_values).subspan(i * each, each)) {
      mean += static_cast<double>(v) / each;
      power += double{v} * v / each;
    }
    error += std::pow(static_cast<double>(values[i]) - mean, 2);
  }
  return std::sqrt(error / power);
}

std::optional<double> noise_error(const Model& model, double clamped) {
  const LrpAnalysis* lrp = lrp_analysis_of(model);
  if (lrp == nullptr || lrp->field.layers.empty()) return std::nullopt;
  WaveField filtered = lrp->field;
  clamp_frequencies(clamped, filtered);
  const auto values_of = [](const WaveField& field) {
    return [&field](std::span<const WavePoint> points, std::span<float> out) {
      sum_waves(field, Seed{1}, points, false, out);
    };
  };
  return filter_error(filtered.channels, values_of(lrp->field), values_of(filtered));
}

std::optional<double> structure_error(const Model& model, double clamped, bool mip) {
  const LrpAnalysis* lrp = lrp_analysis_of(model);
  if (lrp == nullptr || !lrp->fixed) return std::nullopt;
  FixedPhases sharp = *lrp->fixed;
  sharp.turbulence = 0;
  sharp.placement = false;
  FixedPhases filtered = sharp;
  filtered.structure = sharp.structure.filtered(clamped, mip);
  const auto values_of = [](const FixedPhases& fixed) {
    return [&fixed](std::span<const WavePoint> points, std::span<float> out) { fixed.add(Seed{1}, points, out); };
  };
  return filter_error(sharp.structure.image().channels(), values_of(sharp), values_of(filtered));
}

}  // namespace

std::optional<double> lrp_welch_ratio(const Model& model, const Target& target, const Domain&) {
  const LrpAnalysis* lrp = lrp_analysis_of(model);
  if (lrp == nullptr || lrp->field.layers.empty()) return std::nullopt;
  WaveField field = lrp->field;
  const int side = lrp->spectrum.side();
  // The covariance taken modulo a larger torus, whose every second frequency is one of the blocks'.
  const CrossSpectrum fine = wave_spectrum(field, {4 * side, 4 * side});
  CrossSpectrum known;
  for (const Spectrum& factor : fine.factors) {
    Spectrum& coarse = known.factors.emplace_back(Extent{side, side}, 1);
    for (int ky = 0; ky < side; ++ky) {
      for (int kx = 0; kx <= side / 2; ++kx) coarse.at(0, kx, ky) = factor.at(0, 4 * kx, 4 * ky);
    }
  }
  double averaged = 0, single = 0;
  constexpr std::uint64_t samples = 8;
  for (std::uint64_t seed = 0; seed < samples; ++seed) {
    Image sample(target.exemplar.pixels.extent(), field.channels);
    add_waves(field, Seed{seed}, {}, sample);
    Image first(sample.extent(), 1);
    for (int y = 0; y < sample.height(); ++y) std::ranges::copy(sample.row(0, y), first.row(0, y).begin());
    averaged += estimate_error(WelchSpectrum(first, lrp->options.welch), known);
    single +=
        estimate_error(WelchSpectrum(crop(first, 0, 0, {side, side}), {.side = side, .taper = Taper::none}), known);
  }
  return std::sqrt(averaged / single);
}

std::optional<double> lrp_series_error(const Model& model, const Target&, const Domain&) {
  const LrpAnalysis* lrp = lrp_analysis_of(model);
  if (lrp == nullptr || lrp->field.layers.empty()) return std::nullopt;
  WaveField field = lrp->field;
  for (WaveLayer& layer : field.layers) layer.spacing *= 10000;
  const std::int64_t period = lrp->spectrum.side() * plane_pixel;
  std::vector<WavePoint> points;
  points.reserve(1024);
  for (std::int64_t i = 0; i < 512; ++i) {
    const WavePoint& here = points.emplace_back(WavePoint{i * 7 * plane_pixel / 3, i * i % 301 * plane_pixel / 2});
    points.push_back({here.x + period, here.y - 2 * period});
  }
  std::vector<float> values(points.size() * static_cast<std::size_t>(field.channels));
  sum_waves(field, Seed{1}, points, false, values);
  double difference = 0, power = 0;
  for (std::size_t i = 0; i < values.size(); i += 2) {
    difference += std::pow(static_cast<double>(values[i + 1]) - static_cast<double>(values[i]), 2);
    power += double{values[i]} * values[i];
  }
  return std::sqrt(difference / power);
}

std::optional<double> lrp_noise_filter_error(const Model& model, const Target&, const Domain&) {
  return noise_error(model, footprint);
}

std::optional<double> lrp_noise_aliasing_error(const Model& model, const Target&, const Domain&) {
  return noise_error(model, 0);
}

std::optional<double> lrp_structure_filter_error(const Model& model, const Target&, const Domain&) {
  return structure_error(model, footprint, true);
}

std::optional<double> lrp_structure_clamp_error(const Model& model, const Target&, const Domain&) {
  return structure_error(model, footprint, false);
}

std::optional<double> lrp_structure_aliasing_error(const Model& model, const Target&, const Domain&) {
  return structure_error(model, 0, false);
}

std::optional<double> lrp_structure_survival(const Model& model, const Target& target, const Domain&) {
  const LrpAnalysis* lrp = lrp_analysis_of(model);
  if (lrp == nullptr) return std::nullopt;
  const StructureSuggestion suggestion = suggest_structure(target.exemplar, lrp->options.welch, Seed{1});
  const double at = lrp->options.fixed.ratio * static_cast<double>(suggestion.ratios.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, suggestion.ratios.size() - 1);
  return std::lerp(suggestion.survival[below], suggestion.survival[above], at - static_cast<double>(below));
}

std::optional<double> lrp_suggested_structure(const Model& model, const Target& target, const Domain&) {
  const LrpAnalysis* lrp = lrp_analysis_of(model);
  if (lrp == nullptr) return std::nullopt;
  return suggest_structure(target.exemplar, lrp->options.welch, Seed{1}).ratio;
}

}  // namespace textonbench
