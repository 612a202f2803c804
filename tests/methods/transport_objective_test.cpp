#include "methods/spot/transport_objective.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "tests/methods/plane_waves.h"

namespace textonbench::transport_objective_test {

struct Case {
  Extent torus;
  Extent box;
  int channels;
  int kernels;
};

constexpr Case cases[] = {{{12, 9}, {5, 4}, 3, 2},
                          {{11, 10}, {4, 7}, 1, 3},
                          {{8, 8}, {8, 8}, 3, 1},
                          {{9, 13}, {3, 3}, 1, 1},
                          {{9, 8}, {4, 3}, 8, 2}};

TEST(TransportObjective, ValueAndGradientAreThoseOfDirectSums) {
  for (const Case& one : cases) {
    const TransportObjective objective(spot_spectrum(one.torus, one.channels), ragged_mask(one.box));
    const PlaneWaves oracle(objective.target(), ragged_mask(one.box));
    std::vector<double> x =
        random_kernels(static_cast<std::size_t>(one.kernels) * objective.support().size(), objective.variance(), 5);
    std::vector<double> gradient(x.size());
    EXPECT_NEAR(objective.evaluate(x, gradient), oracle.squared_error(oracle.columns(x)), 1e-7);

    double largest = 0;
    for (const double g : gradient) {
      largest = std::max(largest, std::fabs(g));
    }
    const double step = 1e-4 * std::sqrt(objective.variance() / static_cast<double>(x.size()));
    for (std::size_t i = 0; i < x.size(); i += 3) {
      const double center = x[i];
      x[i] = center + step;
      const double above = oracle.squared_error(oracle.columns(x));
      x[i] = center - step;
      const double below = oracle.squared_error(oracle.columns(x));
      x[i] = center;
      EXPECT_NEAR(gradient[i], (above - below) / (2 * step), 2e-6 * largest) << i;
    }
  }
}

TEST(TransportObjective, ValueIsTheRelativeModelErrorOfTheKernelsOnTheTorus) {
  for (const Case& one : cases) {
    const TransportObjective objective(spot_spectrum(one.torus, one.channels), ragged_mask(one.box));
    const std::vector<double> x =
        random_kernels(static_cast<std::size_t>(one.kernels) * objective.support().size(), objective.variance(), 6);
    CrossSpectrum kernels;
    for (const Image& kernel : objective.images(x)) {
      EXPECT_EQ(kernel.extent(), one.box);
      EXPECT_EQ(kernel.at(0, 0, 0), 0) << "off the support";
      Image padded(one.torus, one.channels);
      for (int c = 0; c < one.channels; ++c) {
        for (int y = 0; y < one.box.height; ++y) {
          std::ranges::copy(kernel.row(c, y), padded.row(c, y).begin());
        }
      }
      kernels.factors.push_back(forward_fft(padded));
    }
    std::vector<double> gradient(x.size());
    EXPECT_NEAR(std::sqrt(objective.evaluate(x, gradient)), relative_model_error(kernels, {{objective.target()}}),
                1e-6);
  }
}

TEST(TransportObjective, GradientStepIsAnAlternatingProjection) {
  // T (T* ĥ) / |T* ĥ| for ξ ≠ 0, ĥ(0) as it is, back to the support.
  const TransportObjective objective(spot_spectrum({14, 11}, 3), full_mask({6, 5}));
  std::vector<double> x = random_kernels(objective.support().size(), objective.variance(), 7);
  Image image({14, 11}, 3);
  objective.support().scatter(x, image);
  Spectrum h = forward_fft(image);
  for (int ky = 0; ky < h.rows(); ++ky) {
    for (int kx = ky == 0 ? 1 : 0; kx < h.columns(); ++kx) {
      std::complex<float> product = 0;
      for (int c = 0; c < 3; ++c) {
        product += std::conj(objective.target().at(c, kx, ky)) * h.at(c, kx, ky);
      }
      for (int c = 0; c < 3; ++c) {
        h.at(c, kx, ky) = objective.target().at(c, kx, ky) * product / std::abs(product);
      }
    }
  }
  std::vector<double> projected(x.size());
  objective.support().gather(inverse_fft(h), 1, projected);
  std::vector<double> gradient(x.size());
  objective.evaluate(x, gradient);
  for (std::size_t i = 0; i < x.size(); ++i) {
    ASSERT_NEAR(x[i] - objective.projection_step() * gradient[i], projected[i], 1e-7);
  }
}

TEST(TransportObjective, SameBitsWhateverTheThreads) {
  const TransportObjective objective(spot_spectrum({64, 48}, 3), full_mask({15, 15}));
  const std::vector<double> x = random_kernels(2 * objective.support().size(), objective.variance(), 8);
  std::vector<double> first(x.size());
  std::vector<double> second(x.size());
  double value = 0;
  {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    value = objective.evaluate(x, first);
  }
  EXPECT_EQ(objective.evaluate(x, second), value);
  EXPECT_EQ(first, second);
}

TEST(TransportObjective, RefusesWhatHasNoAnswer) {
  const Spectrum spot = spot_spectrum({10, 8}, 1);
  EXPECT_THROW(TransportObjective(spot, Image({3, 3}, 1)), std::invalid_argument) << "empty";
  EXPECT_THROW(TransportObjective(spot, full_mask({11, 3})), std::invalid_argument) << "too wide";
  EXPECT_THROW(TransportObjective(spot, full_mask({3, 9})), std::invalid_argument) << "too high";
  EXPECT_THROW(TransportObjective(spot, Image({3, 3}, 3)), std::invalid_argument) << "three channels";
  EXPECT_THROW(TransportObjective(Spectrum({10, 8}, 1), full_mask({3, 3})), std::invalid_argument) << "no variance";
}

}  // namespace textonbench::transport_objective_test
