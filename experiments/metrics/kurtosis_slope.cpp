#include "experiments/metrics/kurtosis_slope.h"

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "methods/base/parallel.h"
#include "methods/spot/spot_noise.h"

namespace textonbench {
namespace {

constexpr std::array impact_numbers{5.0, 15.0, 50.0, 150.0, 500.0};
constexpr int sample_count = 16;
constexpr Extent sample_extent{512, 512};

/// Σ z² and Σ z⁴ of each channel about its known mean.
struct EvenPowers {
  std::vector<double> second, fourth;
};

EvenPowers even_powers(const Image& sample, std::span<const double> mean) {
  EvenPowers powers;
  for (int c = 0; c < sample.channels(); ++c) {
    double second = 0, fourth = 0;
    for (int y = 0; y < sample.height(); ++y) {
      for (const float value : sample.row(c, y)) {
        const double z = value - mean[static_cast<std::size_t>(c)];
        second += z * z;
        fourth += z * z * z * z;
      }
    }
    powers.second.push_back(second);
    powers.fourth.push_back(fourth);
  }
  return powers;
}

/// Of all samples but one; of all when `left_out` is none of them.
double pooled_kurtosis(const std::vector<EvenPowers>& samples, std::size_t left_out) {
  const double pixels = static_cast<double>(sample_extent.area()) *
                        static_cast<double>(samples.size() - (left_out < samples.size() ? 1 : 0));
  double sum = 0, channels = 0;
  for (std::size_t c = 0; c < samples.front().second.size(); ++c) {
    double second = 0, fourth = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (i == left_out) continue;
      second += samples[i].second[c];
      fourth += samples[i].fourth[c];
    }
    if (second == 0) continue;
    sum += pixels * fourth / (second * second) - 3;
    ++channels;
  }
  return sum / channels;
}

struct MeasuredKurtosis {
  double value = 0;
  double error = 0;
};

MeasuredKurtosis sampled_kurtosis(const Texton& texton, double mni, Seed seed) {
  const std::unique_ptr<Model> noise = make_spot_noise(texton, {.impacts = Impacts::poisson, .mni = mni});
  std::vector<EvenPowers> samples(sample_count);
  parallel_for(sample_count, [&](int i) {
    const Image sample = noise->synthesize({.size = sample_extent}, derive(seed, static_cast<std::uint64_t>(i)));
    samples[static_cast<std::size_t>(i)] = even_powers(sample, texton.mean);
  });
  std::array<double, sample_count> without{};
  for (std::size_t i = 0; i < samples.size(); ++i) without[i] = pooled_kurtosis(samples, i);
  const double mean = std::accumulate(without.begin(), without.end(), 0.0) / sample_count;
  double squares = 0;
  for (const double value : without) squares += (value - mean) * (value - mean);
  return {pooled_kurtosis(samples, samples.size()), std::sqrt(squares * (sample_count - 1) / sample_count)};
}

}  // namespace

double fitted_exponent(std::span<const double> x, std::span<const double> y, std::span<const double> errors) {
  if (x.size() < 2 || y.size() != x.size() || errors.size() != x.size() || !(y[0] > 0 && y[1] > 0)) {
    throw std::invalid_argument("no power law through these points: expected at least two, the first two positive");
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!(x[i] > 0 && errors[i] > 0)) {
      throw std::invalid_argument("a power law needs positive abscissas and standard errors");
    }
  }
  double b = std::log(y[1] / y[0]) / std::log(x[1] / x[0]);
  double log_a = std::log(y[0]) - b * std::log(x[0]);
  constexpr int most_iterations = 100;
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
    Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double fitted = std::exp(log_a + b * std::log(x[i])) / errors[i];
      const Eigen::Vector2d derivative(fitted, fitted * std::log(x[i]));
      normal += derivative * derivative.transpose();
      gradient += derivative * (y[i] / errors[i] - fitted);
    }
    const Eigen::Vector2d step = normal.ldlt().solve(gradient);
    log_a += step[0];
    b += step[1];
    if (step.norm() < 1e-12) break;
  }
  return b;
}

std::optional<double> kurtosis_slope(const Model& model, const Target& target, const Domain&) {
  if (model.texton() == nullptr) return std::nullopt;
  const Seed seed = derive(derive(Seed{1}, "kurtosis_slope"), target.exemplar.name);
  std::vector<double> kurtosis, errors;
  for (const double mni : impact_numbers) {
    const MeasuredKurtosis measured =
        sampled_kurtosis(*model.texton(), mni, derive(seed, static_cast<std::uint64_t>(mni)));
    kurtosis.push_back(measured.value);
    errors.push_back(measured.error);
  }
  return fitted_exponent(impact_numbers, kurtosis, errors);
}

}  // namespace textonbench
