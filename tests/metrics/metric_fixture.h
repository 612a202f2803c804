// A smooth color texture of known law, samples of models, and one-line measuring, for the tests of the metrics.
#pragma once

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/metrics/metric.h"
#include "methods/base/fft.h"

namespace textonbench {

inline Image white_noise(Extent extent, int channels, std::uint64_t seed) {
  Image image(extent, channels);
  const Stream stream = Stream(Seed{seed}).child("metric test noise");
  for (int c = 0; c < channels; ++c) {
    for (int y = 0; y < extent.height; ++y) {
      fill_normal(stream.child(static_cast<std::uint64_t>(c)), static_cast<std::uint64_t>(y), 0, image.row(c, y));
    }
  }
  return image;
}

/// Torus convolution with a normalized Gaussian of that standard deviation in pixels.
inline Image blurred(const Image& u, double sigma) {
  Spectrum spectrum = forward_fft(u);
  for (int c = 0; c < spectrum.channels(); ++c) {
    for (int ky = 0; ky < spectrum.rows(); ++ky) {
      const double fy = std::min(ky, spectrum.rows() - ky) / static_cast<double>(u.height());
      for (int kx = 0; kx < spectrum.columns(); ++kx) {
        const double fx = kx / static_cast<double>(u.width());
        const double gain = std::exp(-2 * std::pow(std::numbers::pi * sigma, 2) * (fx * fx + fy * fy));
        spectrum.at(c, kx, ky) *= static_cast<float>(gain);
      }
    }
  }
  return inverse_fft(spectrum);
}

/// Applies map(value, channel) to every sample.
template <class Map>
Image mapped(Image u, const Map& map) {
  for (int c = 0; c < u.channels(); ++c) {
    for (int y = 0; y < u.height(); ++y) {
      for (float& value : u.row(c, y)) value = static_cast<float>(map(static_cast<double>(value), c));
    }
  }
  return u;
}

/// Noise blurred by `sigma` pixels, mixed into correlated channels of standard deviations near 0.10, 0.08 and 0.06
/// about 0.5, 0.4 and 0.3; the blue channel is much smoother than the others.
inline Exemplar smooth_exemplar(Extent extent, int channels, double sigma = 1.2, std::uint64_t seed = 1) {
  const Image white = white_noise(extent, 3, seed);
  const Image fine = blurred(white, sigma);
  const Image coarse = blurred(white, 2.5 * sigma);
  // A Gaussian blur of σ leaves white noise with a standard deviation of 1 / (2 σ √π).
  const double gain = 2 * sigma * std::sqrt(std::numbers::pi);
  Image image(extent, channels);
  for (int y = 0; y < extent.height; ++y) {
    for (int x = 0; x < extent.width; ++x) {
      const double a = gain * fine.at(0, x, y), b = gain * fine.at(1, x, y), d = 2.5 * gain * coarse.at(2, x, y);
      const std::array<double, 3> mixed{0.5 + 0.1 * a, 0.4 + 0.064 * a - 0.048 * b, 0.3 - 0.03 * a + 0.05 * d};
      for (int c = 0; c < channels; ++c) image.at(c, x, y) = static_cast<float>(mixed[static_cast<std::size_t>(c)]);
    }
  }
  return {"smooth", std::move(image), std::string(64, '0')};
}

inline std::vector<Image> draw(std::string_view method, const std::map<std::string, ParamValue>& given,
                               const Exemplar& exemplar, const Domain& domain, int count, std::uint64_t seed) {
  const MethodEntry& entry = find_method(method);
  const auto model = entry.analyze({exemplar}, Params(entry.params, given), Seed{seed});
  std::vector<Image> samples;
  samples.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    samples.push_back(model->synthesize(domain, derive(Seed{seed}, static_cast<std::uint64_t>(i))));
  }
  return samples;
}

inline MetricValue measure(std::string_view metric, const Target& target, const std::vector<Image>& samples,
                           const Domain& domain) {
  return measure_samples(*find_metric(metric).of_samples(target, domain, Seed{7}), samples, domain);
}

}  // namespace textonbench
