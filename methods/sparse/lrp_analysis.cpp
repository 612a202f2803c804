#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "methods/base/convolution.h"
#include "methods/base/parallel.h"
#include "methods/sparse/lrp.h"
#include "methods/sparse/wave_filter.h"

namespace textonbench {
namespace {

constexpr int least_side = 32;

/// Colors of one bin: unit vectors and their probabilities.
struct BinColors {
  Eigen::MatrixXcd vectors;
  Eigen::VectorXd chances;
};

/// Eigenvectors of P(k), each with its part of the trace: the mean of a a* is P(k) / tr P(k).
BinColors eigen_colors(const Eigen::MatrixXcd& p) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXcd> solver(p);
  Eigen::VectorXd values = solver.eigenvalues().cwiseMax(0);
  values /= values.sum();
  return {solver.eigenvectors(), values};
}

std::uint32_t as_word(double probability) {
  return static_cast<std::uint32_t>(std::clamp(std::floor(probability * 0x1p32), 0.0, 0x1p32 - 1));
}

/// A layer whose bins have the colors that `colors_of` tells, times the amplitudes of their parts.
template <class Colors>
WaveLayer make_layer(const Stratum& stratum, int channels, int colors, const std::vector<double>& amplitudes,
                     const Colors& colors_of) {
  WaveLayer layer;
  std::vector<double> amplitude_of_bin;
  layer.spacing = std::llround(stratum.spacing * static_cast<double>(std::int64_t{1} << plane_bits));
  layer.colors = colors;
  layer.first.push_back(0);
  for (std::size_t j = 0; j < stratum.parts.size(); ++j) {
    for (const Pixel& bin : stratum.parts[j]) {
      amplitude_of_bin.push_back(amplitudes[j]);
      layer.bins.push_back({bin.x, bin.y});
    }
    layer.first.push_back(static_cast<std::uint32_t>(layer.bins.size()));
  }
  const auto stride = static_cast<std::size_t>(colors);
  layer.chance.resize(layer.bins.size() * stride);
  layer.color.resize(layer.chance.size() * static_cast<std::size_t>(channels));
  parallel_for(static_cast<int>(layer.bins.size()), [&](int bin) {
    const auto at = static_cast<std::size_t>(bin);
    const BinColors& found = colors_of(layer.bins[at].kx, layer.bins[at].ky);
    double sum = 0;
    for (int v = 0; v < colors; ++v) {
      const std::size_t entry = at * stride + static_cast<std::size_t>(v);
      sum += found.chances[v];
      layer.chance[entry] = as_word(sum);
      for (int c = 0; c < channels; ++c) {
        layer.color[entry * static_cast<std::size_t>(channels) + static_cast<std::size_t>(c)] =
            std::complex<float>(amplitude_of_bin[at] * found.vectors(c, v));
      }
    }
  });
  return layer;
}

/// Variance of a layer of one wave of amplitude 1, channels summed.
double unit_variance(const LrpOptions& options) {
  return options.even_variance ? 0.5 : std::numbers::pi * lrp_window_moments(options.strata.window).radial_energy;
}

/// Amplitudes of each layer's waves, from the variance that each is to have.
std::vector<std::vector<double>> amplitudes(const LrpOptions& options, const std::vector<LrpLayer>& layers,
                                            double bins) {
  std::vector<std::vector<double>> wanted;
  double total = 0, sum = 0;
  for (const LrpLayer& layer : layers) {
    const Stratum& stratum = layer.stratum;
    const double spread = options.amplitude == LrpAmplitude::printed ? std::pow(stratum.spacing, 2) : 1;
    std::vector<double>& variances = wanted.emplace_back();
    for (const double energy : stratum.part_energy) {
      const double share = options.amplitude == LrpAmplitude::parts ? energy : stratum.energy / stratum.cosines;
      variances.push_back(share / bins / spread);
      sum += variances.back();
    }
    total += stratum.energy / bins;
  }
  for (std::vector<double>& variances : wanted) {
    for (double& value : variances) value = std::sqrt(value * total / sum / unit_variance(options));
  }
  return wanted;
}

Eigen::MatrixXcd at_bin(const WelchSpectrum& spectrum, int kx, int ky) {
  return spectrum.at(kx, ky < 0 ? ky + spectrum.side() : ky);
}

template <class Power>
PowerPlane power_plane(int side, const Power& power) {
  PowerPlane plane(side);
  for (const Pixel& bin : plane.half()) plane.set(bin.x, bin.y, std::max(0.0, power(bin)));
  return plane;
}

PowerPlane trace_plane(const WelchSpectrum& spectrum) {
  return power_plane(spectrum.side(), [&](const Pixel& bin) {
    return spectrum.power(bin.x, bin.y < 0 ? bin.y + spectrum.side() : bin.y);
  });
}

/// Axes of the color space, the columns, from the least variance to the most.
Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> decorrelate(const WelchSpectrum& spectrum) {
  const PowerPlane plane(spectrum.side());
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(spectrum.channels(), spectrum.channels());
  for (const Pixel& bin : plane.half()) {
    sum += plane.multiplicity(bin) * at_bin(spectrum, bin.x, bin.y).real();
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(sum);
}

/// What the noise is left with beside a structure: its strata, or none when that holds all the power.
std::vector<Stratum> noise_strata(PowerPlane plane, const std::vector<Pixel>& fixed, const LrpOptions& options,
                                  const Stream& stream) {
  const double total = plane.total();
  for (const Pixel& bin : fixed) plane.set(bin.x, bin.y, 0);
  if (plane.total() <= 1e-9 * total) return {};
  StrataOptions left = options.strata;
  left.cosines = std::max(1, static_cast<int>(std::lround((1 - options.fixed.ratio) * options.strata.cosines)));
  left.strata = std::min(left.strata, left.cosines);
  return stratify(plane, left, stream);
}

void add_coherent_layers(const LrpOptions& options, const std::vector<Pixel>& fixed, const Stream& stream,
                         LrpAnalysis& analysis) {
  for (Stratum& stratum : noise_strata(trace_plane(analysis.spectrum), fixed, options, stream)) {
    analysis.layers.push_back({std::move(stratum), -1});
  }
}

void add_independent_layers(const LrpOptions& options, const std::vector<Pixel>& fixed,
                            const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>& axes, const Stream& stream,
                            LrpAnalysis& analysis) {
  const int channels = analysis.spectrum.channels();
  for (int axis = channels - 1; axis >= 0; --axis) {
    if (axes.eigenvalues()[axis] <= 1e-10 * axes.eigenvalues()[channels - 1]) continue;
    const Eigen::VectorXcd direction = axes.eigenvectors().col(axis).cast<std::complex<double>>();
    const PowerPlane plane = power_plane(analysis.spectrum.side(), [&](const Pixel& bin) {
      return (direction.adjoint() * at_bin(analysis.spectrum, bin.x, bin.y) * direction).value().real();
    });
    for (Stratum& stratum : noise_strata(plane, fixed, options, stream.child(static_cast<std::uint64_t>(axis)))) {
      analysis.layers.push_back({std::move(stratum), axis});
    }
  }
}

/// The layers of turbulence, "a rough stratification and a low cosine budget": two strata of three cosines each.
std::vector<WaveField> turbulent_layers(const PowerPlane& trace, const LrpOptions& options, const WaveField& like,
                                        const Stream& stream) {
  LrpOptions rough = options;
  rough.strata.strata = 2;
  rough.strata.cosines = 6;
  rough.amplitude = LrpAmplitude::corrected;
  std::vector<LrpLayer> layers;
  for (Stratum& stratum : stratify(trace, rough.strata, stream)) layers.push_back({std::move(stratum), -1});
  const auto amplitude = amplitudes(rough, layers, static_cast<double>(trace.side()) * trace.side());
  const BinColors gray{Eigen::MatrixXcd::Ones(1, 1), Eigen::VectorXd::Ones(1)};
  std::vector<WaveField> fields;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    WaveField& field = fields.emplace_back(like);
    field.channels = 1;
    field.layers = {
        make_layer(layers[i].stratum, 1, 1, amplitude[i], [&gray](int, int) -> const BinColors& { return gray; })};
  }
  return fields;
}

/// The block nearest to the middle of the exemplar.
Pixel middle_block(const WelchSpectrum& spectrum, Extent size) {
  const auto away = [&](const Pixel& corner) {
    return std::hypot(2 * corner.x + spectrum.side() - size.width, 2 * corner.y + spectrum.side() - size.height);
  };
  return *std::ranges::min_element(spectrum.blocks(), {}, away);
}

/// Takes the structure of those bins from a block of the exemplar.
void fix_phases(const Exemplar& exemplar, const LrpOptions& options, const std::vector<Pixel>& bins,
                const Stream& stream, LrpAnalysis& analysis) {
  const int side = analysis.spectrum.side();
  analysis.block = middle_block(analysis.spectrum, exemplar.pixels.extent());
  Image block = crop(exemplar.pixels, analysis.block.x, analysis.block.y, {side, side});
  std::vector<double> opposite = analysis.spectrum.mean();
  for (double& v : opposite) v = -v;
  add_constant(opposite, block);
  const int cosines = std::max(1, static_cast<int>(std::lround(options.fixed.ratio * options.strata.cosines)));
  Structure structure(restrict_to_bins(block, bins), bins, {.cosines = options.fixed.reduced ? cosines : 0});
  if (options.footprint > 0) structure = structure.filtered(options.footprint);
  FixedPhases& fixed =
      analysis.fixed.emplace(FixedPhases{std::move(structure), options.fixed.turbulence, {}, options.fixed.placement});
  if (fixed.turbulence > 0) {
    fixed.turbulent = turbulent_layers(trace_plane(analysis.spectrum), options, analysis.field, stream);
  }
}

}  // namespace

std::optional<std::string> refuse_lrp(const Exemplar& exemplar, const LrpOptions& options) {
  const auto [width, height] = exemplar.pixels.extent();
  const int smaller = std::min(width, height);
  if (smaller < least_side) {
    return fmt::format("lrp of {}x{} pixels: expected sides of at least {} for a power spectrum", width, height,
                       least_side);
  }
  const int side = options.welch.side;
  if (side != 0 && (side < 8 || side > smaller || !std::has_single_bit(static_cast<unsigned>(side)))) {
    return fmt::format("lrp by blocks of {} in {}x{} pixels: expected 0, or a power of two from 8 to {}", side, width,
                       height, smaller);
  }
  if (options.strata.cosines < options.strata.strata) {
    return fmt::format("lrp of {} cosines in {} strata: expected at least one cosine in each", options.strata.cosines,
                       options.strata.strata);
  }
  const FixedPhaseOptions& fixed = options.fixed;
  if (!(fixed.ratio >= 0 && fixed.ratio <= 1)) {
    return fmt::format("lrp with a structure of {} of the power: expected a number from 0 to 1", fixed.ratio);
  }
  for (const auto& [name, value] : {std::pair{"turbulence", fixed.turbulence}, {"footprint", options.footprint}}) {
    if (!(std::isfinite(value) && value >= 0)) {
      return fmt::format("lrp with {} = {} pixels: expected a finite number from 0 on", name, value);
    }
  }
  return std::nullopt;
}

LrpAnalysis analyze_lrp(const Exemplar& exemplar, const LrpOptions& options, Seed seed) {
  require_usable(exemplar);
  if (const auto reason = refuse_lrp(exemplar, options)) {
    throw std::invalid_argument(fmt::format("{}: {}", exemplar.name, *reason));
  }
  const Stream stream = Stream(seed).child("lrp clusters");
  LrpAnalysis analysis{options, WelchSpectrum(exemplar.pixels, options.welch), {}, {}, {}, {}};
  const WelchSpectrum& spectrum = analysis.spectrum;
  const int channels = spectrum.channels();
  analysis.field.channels = channels;
  analysis.field.side_bits = std::countr_zero(static_cast<unsigned>(spectrum.side()));
  analysis.field.window = options.strata.window;
  analysis.field.even_variance = options.even_variance;

  const std::vector<Pixel> fixed = strongest_bins(trace_plane(spectrum), options.fixed.ratio);
  if (!fixed.empty()) fix_phases(exemplar, options, fixed, stream.child("turbulence"), analysis);

  const bool coherent = options.color == LrpColor::coherent || channels == 1;
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes;
  if (coherent) {
    add_coherent_layers(options, fixed, stream, analysis);
  } else {
    axes = decorrelate(spectrum);
    add_independent_layers(options, fixed, axes, stream, analysis);
  }
  const std::vector<std::vector<double>> amplitude =
      amplitudes(options, analysis.layers, static_cast<double>(spectrum.side()) * spectrum.side());
  for (std::size_t i = 0; i < analysis.layers.size(); ++i) {
    const LrpLayer& layer = analysis.layers[i];
    if (coherent) {
      analysis.field.layers.push_back(make_layer(layer.stratum, channels, channels, amplitude[i], [&](int kx, int ky) {
        return eigen_colors(at_bin(spectrum, kx, ky));
      }));
    } else {
      BinColors only{axes.eigenvectors().col(layer.axis).cast<std::complex<double>>(), Eigen::VectorXd::Ones(1)};
      analysis.field.layers.push_back(
          make_layer(layer.stratum, channels, 1, amplitude[i], [&only](int, int) -> const BinColors& { return only; }));
    }
  }
  clamp_frequencies(options.footprint, analysis.field);
  return analysis;
}

}  // namespace textonbench
