#include "experiments/procedural_exemplars.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include "methods/base/fft.h"
#include "methods/base/params.h"

namespace textonbench {
namespace {

constexpr int noises = 3;
/// A row a channel.
using Mixing = std::vector<std::array<double, noises>>;

/// A power spectrum up to a factor, as a function of frequency in cycles a pixel, each component in [−1/2, 1/2].
using Shape = double (*)(double fx, double fy);

struct Law {
  ProceduralExemplar exemplar;
  std::vector<double> mean;
  std::vector<double> deviation;  ///< standard deviation of each channel
  Mixing mixing;                  ///< rows are scaled to unit length
  Shape shape;

  int channels() const { return static_cast<int>(mean.size()); }
};

double square(double x) { return x * x; }

double white(double /*fx*/, double /*fy*/) { return 1; }

/// Gaussian profile across the circle |f| = 1/12.
double ring(double fx, double fy) { return std::exp(-square((std::hypot(fx, fy) - 1.0 / 12) / 0.012) / 2); }

/// Two Gaussians at ±0.1 in the direction of 30 degrees, longer along it than across. Below 1e-25 at the Nyquist
/// frequencies, where f and −f fall on one bin and no direction could be told.
double oriented_lobe(double fx, double fy) {
  const double angle = std::numbers::pi / 6;
  const double along = fx * std::cos(angle) + fy * std::sin(angle);
  const double across = fy * std::cos(angle) - fx * std::sin(angle);
  const auto lobe = [&](double center) {
    return std::exp(-square((along - center) / 0.03) / 2 - square(across / 0.012) / 2);
  };
  return lobe(0.1) + lobe(-0.1);
}

/// Power 1/|f|², as of natural pictures.
double power_law(double fx, double fy) { return 1 / (square(fx) + square(fy)); }

const std::vector<Law>& laws() {
  static const std::vector<Law> table{
      {.exemplar = {"white_noise", "white noise with correlated colors", Seed{1}},
       .mean = {0.50, 0.50, 0.50},
       .deviation = {0.09, 0.09, 0.09},
       .mixing = {{1.0, 0.4, 0.0}, {0.4, 1.0, 0.4}, {0.0, 0.4, 1.0}},
       .shape = white},
      {.exemplar = {"ring", "annulus of frequencies around 1/12 cycles a pixel", Seed{1}},
       .mean = {0.45, 0.50, 0.55},
       .deviation = {0.08, 0.09, 0.07},
       .mixing = {{1.0, 0.0, 0.3}, {0.8, 0.6, 0.0}, {0.3, 0.5, 0.8}},
       .shape = ring},
      {.exemplar = {"oriented_lobe", "two Gaussian lobes at 0.1 cycles a pixel, 30 degrees", Seed{1}},
       .mean = {0.55, 0.50, 0.45},
       .deviation = {0.09, 0.08, 0.07},
       .mixing = {{1.0, 0.3, 0.0}, {0.9, 0.0, 0.4}, {0.4, -0.8, 0.3}},
       .shape = oriented_lobe},
      {.exemplar = {"power_law", "power 1/f² with correlated colors", Seed{1}},
       .mean = {0.52, 0.50, 0.47},
       .deviation = {0.09, 0.09, 0.08},
       .mixing = {{1.0, 0.3, 0.0}, {0.9, 0.0, 0.3}, {0.8, -0.4, 0.2}},
       .shape = power_law},
      {.exemplar = {"color_and_height",
                    "annulus of frequencies around 1/12 cycles a pixel, in a color and a height map",
                    Seed{1},
                    {{"color", 3}, {"height", 1}}},
       .mean = {0.55, 0.50, 0.45, 0.50},
       .deviation = {0.07, 0.08, 0.09, 0.08},
       .mixing = {{1.0, 0.3, -0.3}, {0.8, 0.0, -0.6}, {0.6, -0.4, -0.7}, {0.0, 0.0, 1.0}},
       .shape = ring},
  };
  return table;
}

const Law& find_law(std::string_view name) {
  std::vector<std::string_view> names;
  for (const Law& law : laws()) {
    if (law.exemplar.name == name) {
      return law;
    }
    names.push_back(law.exemplar.name);
  }
  throw std::invalid_argument(
      fmt::format("no procedural exemplar is called \"{}\"{}", name, did_you_mean(name, names)));
}

/// M: rows of the stated direction, as long as the channel's standard deviation.
Mixing scaled_mixing(const Law& law) {
  Mixing mixing = law.mixing;
  for (std::size_t c = 0; c < mixing.size(); ++c) {
    const double length = std::hypot(mixing[c][0], mixing[c][1], mixing[c][2]);
    for (double& weight : mixing[c]) {
      weight *= law.deviation[c] / length;
    }
  }
  return mixing;
}

/// ŝ on the half spectrum, row by row, with ŝ(0) = 0 and (1/|Ω|) Σ ŝ² = 1.
std::vector<double> scalar_spectrum(Shape shape) {
  const Spectrum layout(procedural_extent, 1);
  const auto [width, height] = procedural_extent;
  std::vector<double> s;
  s.reserve(static_cast<std::size_t>(layout.bins()));
  double sum = 0;
  for (int ky = 0; ky < layout.rows(); ++ky) {
    const double fy = static_cast<double>(ky <= height / 2 ? ky : ky - height) / height;
    for (int kx = 0; kx < layout.columns(); ++kx) {
      const double power = kx == 0 && ky == 0 ? 0 : shape(static_cast<double>(kx) / width, fy);
      s.push_back(power);
      sum += layout.multiplicity(kx) * power;
    }
  }
  const double scale = static_cast<double>(procedural_extent.area()) / sum;
  for (double& value : s) {
    value = std::sqrt(value * scale);
  }
  return s;
}

}  // namespace

std::span<const ProceduralExemplar> procedural_exemplars() {
  static const auto exemplars = [] {
    std::vector<ProceduralExemplar> list;
    for (const Law& law : laws()) {
      list.push_back(law.exemplar);
    }
    return list;
  }();
  return exemplars;
}

Image draw_procedural(std::string_view name, Seed seed) {
  const Law& law = find_law(name);
  const Mixing mixing = scaled_mixing(law);
  const std::vector<double> s = scalar_spectrum(law.shape);
  const Stream stream = Stream(seed).child("procedural_exemplar").child(name);

  Image noise(procedural_extent, noises);
  for (int k = 0; k < noises; ++k) {
    const Stream plane = stream.child(static_cast<std::uint64_t>(k));
    for (int y = 0; y < noise.height(); ++y) {
      fill_normal(plane, static_cast<std::uint64_t>(y), 0, noise.row(k, y));
    }
  }

  const Spectrum white_spectrum = forward_fft(noise);
  Spectrum spectrum = Spectrum::uninitialized(procedural_extent, law.channels());
  std::size_t bin = 0;
  for (int ky = 0; ky < spectrum.rows(); ++ky) {
    for (int kx = 0; kx < spectrum.columns(); ++kx, ++bin) {
      std::array<std::complex<double>, noises> w;
      for (int k = 0; k < noises; ++k) {
        w[static_cast<std::size_t>(k)] = white_spectrum.at(k, kx, ky);
      }
      for (int c = 0; c < law.channels(); ++c) {
        const auto& m = mixing[static_cast<std::size_t>(c)];
        spectrum.at(c, kx, ky) = std::complex<float>(s[bin] * (m[0] * w[0] + m[1] * w[1] + m[2] * w[2]));
      }
    }
  }
  for (int c = 0; c < law.channels(); ++c) {
    const double sum = law.mean[static_cast<std::size_t>(c)] * static_cast<double>(procedural_extent.area());
    spectrum.at(c, 0, 0) = static_cast<float>(sum);
  }
  return inverse_fft(spectrum);
}

std::vector<double> known_mean(std::string_view name) { return find_law(name).mean; }

CrossSpectrum known_spectrum(std::string_view name) {
  const Law& law = find_law(name);
  const Mixing mixing = scaled_mixing(law);
  const std::vector<double> s = scalar_spectrum(law.shape);
  CrossSpectrum p;
  for (std::size_t k = 0; k < noises; ++k) {
    Spectrum factor(procedural_extent, law.channels());
    for (int c = 0; c < law.channels(); ++c) {
      for (int ky = 0; ky < factor.rows(); ++ky) {
        for (int kx = 0; kx < factor.columns(); ++kx) {
          const auto bin = static_cast<std::size_t>(std::int64_t{ky} * factor.columns() + kx);
          factor.at(c, kx, ky) = static_cast<float>(s[bin] * mixing[static_cast<std::size_t>(c)][k]);
        }
      }
    }
    p.factors.push_back(std::move(factor));
  }
  return p;
}

}  // namespace textonbench
