#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tests/metrics/metric_fixture.h"

namespace textonbench::patch_distance_test {

double normal_cdf(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

double normal_quantile(double u) {
  double low = -10, high = 10;
  for (int i = 0; i < 60; ++i) (normal_cdf(0.5 * (low + high)) < u ? low : high) = 0.5 * (low + high);
  return 0.5 * (low + high);
}

/// ∫ (F_n⁻¹(u) − Φ⁻¹(u))² du by the midpoint rule, `steps` points between two order statistics.
double naive_wasserstein(std::vector<double> z, const std::vector<double>& quantiles, int steps) {
  std::sort(z.begin(), z.end());
  double sum = 0;
  for (std::size_t i = 0; i < quantiles.size(); ++i) {
    const double difference = z[i / static_cast<std::size_t>(steps)] - quantiles[i];
    sum += difference * difference;
  }
  return sum / static_cast<double>(quantiles.size());
}

/// The metric from its definition, by filters on the full-size image: a direction on a patch of averages is a filter of
/// side box · w, its response's variance a double sum over the covariance.
double naive_patch_distance(const Target& target, const Image& u, Seed seed) {
  const int channels = u.channels();
  double total = 0;
  int directions = 0;
  for (int pair = 0; pair < 6; ++pair) {
    const int box = 1 << (pair / 2), w = pair % 2 == 0 ? 3 : 8, side = box * w;
    const int spacing = box * std::max(1, w / 2);
    const int across = u.width() / box * box, down = u.height() / box * box;
    if (across < side || down < side) continue;
    const int n = ((across - side) / spacing + 1) * ((down - side) / spacing + 1);
    constexpr int steps = 2000;
    std::vector<double> quantiles(static_cast<std::size_t>(n) * steps);
    for (std::size_t i = 0; i < quantiles.size(); ++i) {
      quantiles[i] = normal_quantile((static_cast<double>(i) + 0.5) / static_cast<double>(quantiles.size()));
    }
    const Stream stream = Stream(seed).child("patch_distance").child(static_cast<std::uint64_t>(pair));
    const int count = 512 / 6 + (pair < 2 ? 1 : 0);
    for (int k = 0; k < count; ++k) {
      Eigen::VectorXf normal(channels * w * w);
      fill_normal(stream, static_cast<std::uint64_t>(k), 0, {normal.data(), static_cast<std::size_t>(normal.size())});
      normal.normalize();
      const auto filter = [&](int c, int x, int y) {
        return static_cast<double>(normal((c * w + y / box) * w + x / box)) / (box * box);
      };
      // Correlate the filter with itself first: 4 nested loops over lags and taps.
      double variance = 0;
      for (int vy = 1 - side; vy < side; ++vy) {
        for (int vx = 1 - side; vx < side; ++vx) {
          for (int c = 0; c < channels; ++c) {
            for (int d = 0; d < channels; ++d) {
              double product = 0;
              for (int y = std::max(0, -vy); y < std::min(side, side - vy); ++y) {
                for (int x = std::max(0, -vx); x < std::min(side, side - vx); ++x) {
                  product += filter(c, x + vx, y + vy) * filter(d, x, y);
                }
              }
              variance += product * target.covariance.at(c, d, vx, vy);
            }
          }
        }
      }
      std::vector<double> z;
      for (int top = 0; top + side <= down; top += spacing) {
        for (int left = 0; left + side <= across; left += spacing) {
          double response = 0;
          for (int c = 0; c < channels; ++c) {
            for (int y = 0; y < side; ++y) {
              for (int x = 0; x < side; ++x) {
                response +=
                    filter(c, x, y) * (u.at(c, left + x, top + y) - target.gaussian.mean[static_cast<std::size_t>(c)]);
              }
            }
          }
          z.push_back(response / std::sqrt(variance));
        }
      }
      total += naive_wasserstein(z, quantiles, steps);
      ++directions;
    }
  }
  return total / directions;
}

// The midpoint rule misses some 1e-3 of the tails' contribution to a distance that is near 0.1 here.
TEST(PatchDistance, IsItsDefinition) {
  const Exemplar exemplar = smooth_exemplar({21, 18}, 1, 0.8);
  const Target target = make_target(exemplar);
  const Domain domain{.size = {21, 18}, .periodic = true};
  const Image sample = mapped(white_noise(domain.size, 1, 3), [](double v, int) { return 0.45 + 0.08 * v; });
  EXPECT_NEAR(measure("patch_distance", target, {sample}, domain).value, naive_patch_distance(target, sample, Seed{7}),
              1e-3);
}

// Patches of white noise of contrast a are N(m, a² Σ) where the target's are N(m, Σ), so W2² = (1 − a)² in every
// direction, up to the sampling noise of 500 to 16000 patches.
TEST(PatchDistance, OfScaledWhiteNoiseIsTheSquareOfTheContrastError) {
  const Exemplar exemplar{"white", mapped(white_noise({256, 256}, 3, 5), [](double v, int) { return 0.5 + 0.1 * v; }),
                          std::string(64, '0')};
  const Target target = make_target(exemplar);
  const Domain domain{.size = {256, 256}, .periodic = true};
  for (const double a : {1.0, 0.6, 1.5}) {
    std::vector<Image> samples = draw("adsn", {}, exemplar, domain, 4, 6);
    for (Image& sample : samples) {
      sample = mapped(sample, [&](double value, int c) {
        const double m = target.gaussian.mean[static_cast<std::size_t>(c)];
        return m + a * (value - m);
      });
    }
    EXPECT_NEAR(measure("patch_distance", target, samples, domain).value, (1 - a) * (1 - a), 0.01) << a;
  }
}

TEST(PatchDistance, OfTheMeanIsTheWholeVariance) {
  const Exemplar exemplar = smooth_exemplar({40, 30}, 3);
  const Target target = make_target(exemplar);
  for (const Domain domain : {Domain{.size = {40, 30}, .periodic = true}, Domain{.size = {9, 5}, .periodic = false},
                              Domain{.size = {700, 3}, .periodic = false}}) {
    const std::vector<Image> flat{mapped(
        Image(domain.size, 3), [&](double, int c) { return target.gaussian.mean[static_cast<std::size_t>(c)]; })};
    EXPECT_NEAR(measure("patch_distance", target, flat, domain).value, 1, 1e-4);
  }
}

TEST(PatchDistance, NeedsAPatch) {
  const Exemplar exemplar = smooth_exemplar({40, 30}, 3);
  const Target target = make_target(exemplar);
  EXPECT_THROW(find_metric("patch_distance").of_samples(target, {.size = {40, 2}}, Seed{1}), std::invalid_argument);
}

}  // namespace textonbench::patch_distance_test
