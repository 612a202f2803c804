// Law of texton noise: mean, covariance and fourth moment against closed forms.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "benchmarks/scalar_texton_noise.h"
#include "methods/base/bspline.h"
#include "methods/spot/spline_noise.h"
#include "tests/base/statistics.h"
#include "tests/texton.h"

namespace textonbench::spline_noise_law_test {

/// Of each comparison below; seeds are fixed.
constexpr double false_alarm = 1e-6;

SplineTexton small_texton(int channels, int kernels, int order, ImpactProcess process) {
  SplineTexton texton{test_texton({6, 5}, channels, kernels), order, 0};
  texton.support_area = (6.0 + order) * (5.0 + order);
  if (process == ImpactProcess::stratified) texton.coefficients.mean.assign(static_cast<std::size_t>(channels), -0.25);
  return texton;
}

/// (Σ_k α_k * α~_k * b)(x, y), summed as it is written.
double covariance(const SplineTexton& texton, int c, int d, int x, int y) {
  const auto b = bspline_autocorrelation(texton.order);
  const auto at = [](const Image& image, int channel, int px, int py) {
    const bool inside = px >= 0 && py >= 0 && px < image.width() && py < image.height();
    return inside ? static_cast<double>(image.at(channel, px, py)) : 0.0;
  };
  double sum = 0;
  for (const Image& kernel : texton.coefficients.kernels) {
    for (int v = -texton.order; v <= texton.order; ++v) {
      for (int u = -texton.order; u <= texton.order; ++u) {
        double correlation = 0;
        for (int py = 0; py < kernel.height(); ++py) {
          for (int px = 0; px < kernel.width(); ++px) {
            correlation += at(kernel, c, px + x - u, py + y - v) * at(kernel, d, px, py);
          }
        }
        sum += b[static_cast<std::size_t>(std::abs(u))] * b[static_cast<std::size_t>(std::abs(v))] * correlation;
      }
    }
  }
  return sum;
}

/// p-value of the mean of independent numbers against what is expected.
double p_value_of_mean(const std::vector<double>& numbers, double expected) {
  const auto n = static_cast<double>(numbers.size());
  double sum = 0;
  double squares = 0;
  for (const double v : numbers) {
    sum += v - expected;
    squares += (v - expected) * (v - expected);
  }
  const double variance = (squares - sum * sum / n) / (n - 1);
  return normal_p_value(sum / n / std::sqrt(variance / n));
}

TEST(SplineNoiseLaw, MeanAndCovarianceOnShiftedGrids) {
  struct Lag {
    int c, d, x, y;
  };
  const std::vector<Lag> lags = {{0, 0, 0, 0}, {1, 1, 0, 0}, {0, 1, 0, 0},  {0, 0, 1, 0}, {0, 0, 0, 1},
                                 {1, 1, 2, 1}, {0, 1, 3, 2}, {1, 0, -1, 1}, {0, 0, 9, 0}};
  for (const ImpactProcess process : {ImpactProcess::poisson, ImpactProcess::stratified}) {
    for (const int order : {0, 1, 3}) {
      const SplineTexton texton = small_texton(2, 2, order, process);
      const auto model = make_spline_noise(texton, {.impacts = process, .mni = 4});
      for (const double shift : {0.0, 0.25, 0.5}) {
        constexpr int side = 40;
        std::array<std::vector<double>, 2> means;
        std::vector<std::vector<double>> products(lags.size());
        for (std::uint64_t seed = 0; seed < 200; ++seed) {
          const Image field = model->synthesize({.size = {side, side}, .origin = {shift - 9, shift + 1e5}}, Seed{seed});
          const auto centered = [&](int c, int x, int y) {
            return field.at(c, x, y) - texton.coefficients.mean[static_cast<std::size_t>(c)];
          };
          for (int c = 0; c < 2; ++c) {
            double sum = 0;
            for (int i = 0; i < side * side; ++i) sum += centered(c, i % side, i / side);
            means[static_cast<std::size_t>(c)].push_back(sum / (side * side));
          }
          for (std::size_t l = 0; l < lags.size(); ++l) {
            const auto [c, d, dx, dy] = lags[l];
            double sum = 0;
            for (int y = 0; y < side - 2; ++y) {
              for (int x = 1; x < side - 9; ++x) sum += centered(c, x + dx, y + dy) * centered(d, x, y);
            }
            products[l].push_back(sum / ((side - 2) * (side - 10)));
          }
        }
        for (const auto& mean : means) {
          EXPECT_GT(p_value_of_mean(mean, 0), false_alarm) << order << " " << shift;
        }
        for (std::size_t l = 0; l < lags.size(); ++l) {
          const auto [c, d, dx, dy] = lags[l];
          EXPECT_GT(p_value_of_mean(products[l], covariance(texton, c, d, dx, dy)), false_alarm)
              << "order " << order << " shift " << shift << " lag " << l;
        }
      }
    }
  }
}

/// ∫ h^power over the plane, by the rule of midpoints of 1/16 pixel.
double kernel_integral(const SplineTexton& texton, const Image& kernel, int power) {
  constexpr int steps = 16;
  const int reach = steps * (texton.order + 1) / 2;
  double sum = 0;
  for (int iy = -reach; iy < steps * (kernel.height() - 1) + reach; ++iy) {
    for (int ix = -reach; ix < steps * (kernel.width() - 1) + reach; ++ix) {
      double h = 0;
      for (int y = 0; y < kernel.height(); ++y) {
        const double wy = bspline(texton.order, (iy + 0.5) / steps - y);
        for (int x = 0; x < kernel.width() && wy != 0; ++x) {
          h += kernel.at(0, x, y) * wy * bspline(texton.order, (ix + 0.5) / steps - x);
        }
      }
      sum += std::pow(h, power);
    }
  }
  return sum / (steps * steps);
}

TEST(SplineNoiseLaw, FourthCumulantByCampbell) {
  // With impacts of intensity λ that take sqrt(K) h_k, divided by sqrt(λ): κ4 = (K / λ) Σ_k ∫ h_k⁴.
  for (const int order : {1, 3}) {
    for (const int kernels : {1, 2}) {
      const SplineTexton texton = small_texton(1, kernels, order, ImpactProcess::poisson);
      constexpr double mni = 3;
      const auto model = make_spline_noise(texton, {.mni = mni});
      double fourth = 0;
      double variance = 0;
      for (const Image& kernel : texton.coefficients.kernels) {
        fourth += kernel_integral(texton, kernel, 4) * kernels * texton.support_area / mni;
        variance += kernel_integral(texton, kernel, 2);
      }
      EXPECT_NEAR(variance, covariance(texton, 0, 0, 0, 0), 2e-3 * variance);
      std::vector<double> cumulants;
      std::vector<float> values(1000);
      std::vector<Point2> points;
      for (int i = 0; i < 1000; ++i) points.push_back({100.3 * (i % 100), 99.7 * (i / 100)});
      for (std::uint64_t seed = 0; seed < 100; ++seed) {
        model->procedural()->evaluate(points, Seed{seed}, values);
        double sum = 0;
        for (const float value : values) {
          const double v = value - texton.coefficients.mean[0];
          // E f⁴ = κ4 + 3 σ⁴, the variance being known.
          sum += v * v * v * v - 6 * variance * v * v + 3 * variance * variance;
        }
        cumulants.push_back(sum / 1000);
      }
      EXPECT_GT(p_value_of_mean(cumulants, fourth), false_alarm) << order << " " << kernels;
      EXPECT_LT(p_value_of_mean(cumulants, 0), false_alarm);
    }
  }
}

TEST(SplineNoiseLaw, TheScalarLoopDrawsThePapersNoise) {
  SplineTexton texton{test_texton({11, 9}, 3, 1), 1, 120};
  for (const ImpactProcess process : {ImpactProcess::paper, ImpactProcess::poisson, ImpactProcess::stratified}) {
    const ImpactGrid grid(process, 30 / texton.support_area, 0.6 * std::sqrt(texton.support_area), 1);
    const ScalarTextonNoise scalar(texton, grid, Stream(Seed{5}).child("texton noise").key());
    const Image plain = scalar.draw(64);
    const auto model = make_spline_noise(texton, {.impacts = process, .mni = 30, .cell = 0.6});
    const Image ours = model->synthesize({.size = {64, 64}}, Seed{5});
    for (int c = 0; c < 3; ++c) {
      const double deviation = std::sqrt(covariance(texton, c, c, 0, 0));
      for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
          // Its coordinates are floats of up to 64 pixels.
          ASSERT_NEAR(ours.at(c, x, y), plain.at(c, x, y), 2e-4 * deviation);
        }
      }
    }
  }
}

}  // namespace textonbench::spline_noise_law_test
