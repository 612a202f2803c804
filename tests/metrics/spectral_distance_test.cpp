#include <gtest/gtest.h>

#include <cmath>

#include "tests/metrics/metric_fixture.h"

namespace textonbench::spectral_distance_test {

TEST(LogSpectralDistance, OfARandomPhaseImageIsZeroAndOfItsContrastExact) {
  const Exemplar exemplar = smooth_exemplar({96, 80}, 3);
  const Target target = make_target(exemplar);
  const Domain domain{.size = {96, 80}, .periodic = true};
  const std::vector<Image> exact = draw("rpn", {}, exemplar, domain, 1, 4);
  EXPECT_NEAR(measure("log_spectral_distance", target, exact, domain).value, 0, 1e-4);
  const std::vector<Image> scaled{mapped(exact.front(), [&](double value, int c) {
    const double m = target.gaussian.mean[static_cast<std::size_t>(c)];
    return m + 0.5 * (value - m);
  })};
  EXPECT_NEAR(measure("log_spectral_distance", target, scaled, domain).value, 20 * std::log10(2.0), 1e-4);
  const std::vector<Image> flat{
      mapped(exact.front(), [&](double, int c) { return target.gaussian.mean[static_cast<std::size_t>(c)]; })};
  EXPECT_NEAR(measure("log_spectral_distance", target, flat, domain).value, 100, 1e-4);
}

/// Power of a sample of white noise under the window in bin after bin, as the metric's statistic returns it.
TEST(LogSpectralDistance, StatisticIsAPartitionOfTheWindowedPower) {
  const Exemplar exemplar = smooth_exemplar({40, 32}, 3);
  const Target target = make_target(exemplar);
  const Domain domain{.size = {27, 36}, .periodic = false};
  const Image sample = mapped(white_noise(domain.size, 3, 3), [](double value, int) { return 0.4 + 0.1 * value; });
  const auto metric = find_metric("log_spectral_distance").of_samples(target, domain, Seed{1});
  double total = 0;
  for (const float power : metric->statistic(sample, domain)) total += power;

  // Parseval: Σ_ξ |û_w|² = |Ω| Σ (w u)², less the frequency zero.
  double energy = 0, window_energy = 0;
  for (int c = 0; c < 3; ++c) {
    double squares = 0, sum = 0;
    window_energy = 0;
    for (int y = 0; y < 36; ++y) {
      for (int x = 0; x < 27; ++x) {
        const double w = std::pow(std::sin(std::numbers::pi * (x + 0.5) / 27), 2) *
                         std::pow(std::sin(std::numbers::pi * (y + 0.5) / 36), 2);
        const double u = w * (sample.at(c, x, y) - target.gaussian.mean[static_cast<std::size_t>(c)]);
        squares += u * u;
        sum += u;
        window_energy += w * w;
      }
    }
    energy += 27 * 36 * squares - sum * sum;
  }
  EXPECT_NEAR(total / (energy / window_energy), 1, 1e-5);
}

// The expectation under the window is exact: over 400 samples the error of a bin of f independent frequencies is about
// 3.5 dB / sqrt(400 f), at most 0.2 dB, and the mean over more than 20 bins stays below 0.15 dB (6 sd). Without the
// window in the target's power the distance would be over 1 dB.
TEST(LogSpectralDistance, KnowsTheEffectOfTheWindow) {
  const Exemplar exemplar = smooth_exemplar({48, 40}, 3, 2.0);
  const Target target = make_target(exemplar);
  for (const Extent size : {Extent{32, 40}, Extent{64, 56}}) {
    const Domain domain{.size = size, .periodic = false};
    EXPECT_LT(measure("log_spectral_distance", target, draw("adsn", {}, exemplar, domain, 400, 4), domain).value, 0.15);
  }
}

}  // namespace textonbench::spectral_distance_test
