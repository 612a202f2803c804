#include "experiments/metrics/cramer_von_mises.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/metrics/metric_fixture.h"

namespace textonbench::cramer_von_mises_test {

double normal_cdf(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

TEST(DecorrelationLength, IsTheReachOfTheAutocorrelation) {
  // A Gaussian blur of σ gives ρ(v) = exp(−|v|² / 4σ²), 0.1 at |v| = 3.03 σ.
  const Exemplar gray = smooth_exemplar({256, 256}, 1, 2.0);
  EXPECT_NEAR(decorrelation_length(make_target(gray)), std::floor(3.03 * 2.0) + 1, 1);
  // The blue channel is mostly a blur of 2.5 σ.
  const Exemplar color = smooth_exemplar({256, 256}, 3, 2.0);
  EXPECT_NEAR(decorrelation_length(make_target(color)), std::floor(3.03 * 5.0) + 1, 4);

  // |ρ| = 1 at every lag.
  Exemplar checkers{"checkers", Image({32, 24}, 1), std::string(64, '0')};
  for (int y = 0; y < 24; ++y) {
    for (int x = 0; x < 32; ++x) checkers.pixels.at(0, x, y) = static_cast<float>((x + y) % 2);
  }
  EXPECT_EQ(decorrelation_length(make_target(checkers)), 17);
}

// n ∫ (F_n − Φ)² dΦ, by quadrature in u = Φ(z), for all shifts of the grid: the metric's is one of them.
TEST(CramerVonMises, IsTheIntegralOfItsDefinition) {
  const Exemplar exemplar = smooth_exemplar({60, 45}, 1, 1.0);
  const Target target = make_target(exemplar);
  const Domain domain{.size = {60, 45}, .periodic = true};
  const Image sample = mapped(exemplar.pixels, [](double value, int) { return 0.03 + value; });
  const double measured = measure("cramer_von_mises", target, {sample}, domain).value;

  const int spacing = decorrelation_length(target);
  const double sd = std::sqrt(target.covariance.at(0, 0, 0, 0));
  double nearest = 1e9;
  for (int top = 0; top < spacing; ++top) {
    for (int left = 0; left < spacing; ++left) {
      std::vector<double> u;
      for (int j = 0; j < 45 / spacing; ++j) {
        for (int i = 0; i < 60 / spacing; ++i) {
          const double value = sample.at(0, left + i * spacing, top + j * spacing);
          u.push_back(normal_cdf((value - target.gaussian.mean[0]) / sd));
        }
      }
      constexpr int steps = 20000;
      double integral = 0;
      std::sort(u.begin(), u.end());
      std::size_t below = 0;
      for (int s = 0; s < steps; ++s) {
        const double at = (s + 0.5) / steps;
        while (below < u.size() && u[below] <= at) ++below;
        integral += std::pow(static_cast<double>(below) / static_cast<double>(u.size()) - at, 2) / steps;
      }
      nearest = std::min(nearest, std::abs(static_cast<double>(u.size()) * integral - measured));
    }
  }
  EXPECT_LT(nearest, 2e-3);
}

// T of n independent pixels has mean 1/6 and variance below 1/45: with 300 samples of one white channel the mean lies
// within 4 sd = 0.0345 of 1/6 with probability 1 − 6e-5.
TEST(CramerVonMises, ScoresOneSixthForTheExactLaw) {
  const Exemplar exemplar{"white", mapped(white_noise({64, 64}, 1, 5), [](double v, int) { return 0.5 + 0.1 * v; }),
                          std::string(64, '0')};
  const Target target = make_target(exemplar);
  const double sd = std::sqrt(target.covariance.at(0, 0, 0, 0));
  for (const Extent size : {Extent{64, 64}, Extent{1, 1}}) {
    const Domain domain{.size = size, .periodic = false};
    std::vector<Image> samples;
    samples.reserve(300);
    for (std::uint64_t i = 0; i < 300; ++i) {
      samples.push_back(mapped(white_noise(size, 1, 1000 + i),
                               [&](double value, int) { return target.gaussian.mean[0] + sd * value; }));
    }
    const MetricValue measured = measure("cramer_von_mises", target, samples, domain);
    EXPECT_NEAR(measured.value, 1.0 / 6, 0.0345);
    EXPECT_NEAR(*measured.stderr_value, std::sqrt(1.0 / 45 / 300), 0.005);
  }
}

}  // namespace textonbench::cramer_von_mises_test
