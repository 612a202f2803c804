#include "methods/sparse/lrp_suggestion.h"

#include <array>
#include <cmath>

#include "methods/base/fft.h"
#include "methods/sparse/lrp.h"
#include "methods/sparse/structure.h"

namespace textonbench {
namespace {

constexpr int phase_draws = 8;
constexpr int ratio_steps = 20;

/// Skewness and half the excess kurtosis, which scatter alike, and the variance.
struct Moments {
  double shape[2] = {};
  double variance = 0;
};

Moments moments_of(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  double mean = 0, second = 0, third = 0, fourth = 0;
  for (const double v : values) mean += v / n;
  for (const double v : values) {
    const double d = v - mean;
    second += d * d, third += d * d * d, fourth += d * d * d * d;
  }
  if (second <= 0) return {};
  return {{third / n / std::pow(second / n, 1.5), 0.5 * (fourth * n / (second * second) - 3)}, second / n};
}

constexpr int octave_count = 5;
using Numbers = std::array<Moments, std::size_t{2} * octave_count>;

/// Of the differences of means over neighboring squares of 1, 2, 4, 8 and 16 pixels a side.
Numbers numbers_of(const Image& u) {
  const int width = u.width() + 1, height = u.height() + 1;
  std::vector<double> sums(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  const auto sum = [&](int x, int y) -> double& {
    return sums[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  };
  for (int y = 0; y < u.height(); ++y) {
    for (int x = 0; x < u.width(); ++x) {
      sum(x + 1, y + 1) = static_cast<double>(u.at(0, x, y)) + sum(x, y + 1) + sum(x + 1, y) - sum(x, y);
    }
  }
  Numbers all{};
  for (int octave = 0; octave < octave_count; ++octave) {
    const int side = 1 << octave;
    const auto square = [&](int x, int y) {
      return (sum(x + side, y + side) - sum(x, y + side) - sum(x + side, y) + sum(x, y)) / (side * side);
    };
    for (int axis = 0; axis < 2; ++axis) {
      const int dx = axis == 0 ? side : 0, dy = side - dx;
      std::vector<double> values;
      values.reserve(sums.size());
      for (int y = 0; y + dy + side <= u.height(); ++y) {
        for (int x = 0; x + dx + side <= u.width(); ++x) values.push_back(square(x + dx, y + dy) - square(x, y));
      }
      all[2 * static_cast<std::size_t>(octave) + static_cast<std::size_t>(axis)] = moments_of(values);
    }
  }
  return all;
}

double squared_distance(const Numbers& a, const Numbers& b) {
  double sum = 0, weights = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double weight = a[i].variance + b[i].variance;
    weights += weight;
    for (int k = 0; k < 2; ++k) sum += weight * std::pow(a[i].shape[k] - b[i].shape[k], 2);
  }
  return sum / weights;
}

}  // namespace

StructureSuggestion suggest_structure(const Exemplar& exemplar, const WelchOptions& welch, Seed seed) {
  const LrpAnalysis analysis =
      analyze_lrp(exemplar, {.welch = welch, .strata = {}, .fixed = {.ratio = 1, .reduced = false}}, seed);
  const Image& colors = analysis.fixed->structure.image();
  const int side = colors.width();
  Image block({side, side}, 1);
  for (int c = 0; c < colors.channels(); ++c) {
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) block.at(0, x, y) += colors.at(c, x, y);
    }
  }
  const Spectrum spectrum = forward_fft(block);
  PowerPlane plane(side);
  for (const Pixel& bin : plane.half()) {
    const int x = bin.x, y = (bin.y + side) % side;
    plane.set(bin.x, bin.y, x == 0 && y == 0 ? 0.0 : static_cast<double>(std::norm(spectrum.at(0, x, y))));
  }
  const Stream stream = Stream(seed).child("lrp suggestion");
  std::vector<Image> random;  // all phases of the block at random
  for (int d = 0; d < phase_draws; ++d) {
    // White noise has the symmetries that phases need.
    Image white({side, side}, 1);
    for (int y = 0; y < side; ++y) {
      fill_normal(stream.child(static_cast<std::uint64_t>(d)), static_cast<std::uint64_t>(y), 0, white.row(0, y));
    }
    Spectrum phases = forward_fft(white);
    for (int ky = 0; ky < side; ++ky) {
      for (int kx = 0; kx <= side / 2; ++kx) {
        const std::complex<float> z = phases.at(0, kx, ky);
        phases.at(0, kx, ky) = std::abs(z) > 0 ? std::abs(spectrum.at(0, kx, ky)) * z / std::abs(z) : 0;
      }
    }
    random.push_back(inverse_fft(phases));
  }
  const Numbers own = numbers_of(block);
  std::vector<Numbers> of_random;
  of_random.reserve(random.size());
  StructureSuggestion suggestion;
  for (const Image& image : random) of_random.push_back(numbers_of(image));
  for (int a = 0; a < phase_draws; ++a) {
    suggestion.distance += squared_distance(of_random[static_cast<std::size_t>(a)], own) / phase_draws;
    for (int b = 0; b < a; ++b) {
      suggestion.chance +=
          squared_distance(of_random[static_cast<std::size_t>(a)], of_random[static_cast<std::size_t>(b)]) /
          (phase_draws * (phase_draws - 1) / 2.0);
    }
  }
  suggestion.gaussian = suggestion.distance <= 2 * suggestion.chance;
  for (int step = 0; step <= ratio_steps; ++step) {
    const double ratio = static_cast<double>(step) / ratio_steps;
    const std::vector<Pixel> bins = strongest_bins(plane, ratio);
    const Image fixed = restrict_to_bins(block, bins);
    double distance = 0;
    for (const Image& image : random) {
      const Image removed = restrict_to_bins(image, bins);
      Image mixed = image;
      for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) mixed.at(0, x, y) += fixed.at(0, x, y) - removed.at(0, x, y);
      }
      distance += squared_distance(numbers_of(mixed), own) / phase_draws;
    }
    suggestion.ratios.push_back(ratio);
    suggestion.survival.push_back(1 - distance / suggestion.distance);
    if (!suggestion.gaussian && suggestion.ratio == 0 && suggestion.survival.back() >= 0.5) suggestion.ratio = ratio;
  }
  return suggestion;
}

}  // namespace textonbench
