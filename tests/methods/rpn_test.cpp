#include "methods/spectral/rpn.h"

#include <gtest/gtest.h>

#include <complex>
#include <numbers>

#include "methods/base/spectrum.h"
#include "tests/texture.h"

namespace textonbench::rpn_test {

/// First column of row ky, the mean left out.
int kx_start(int ky) { return ky == 0 ? 1 : 0; }

Domain torus(Extent size) { return {.size = size, .periodic = true}; }

TEST(Rpn, HasExactlyTheModulusOfThePeriodicComponent) {
  for (const Extent extent : {Extent{32, 24}, Extent{31, 24}, Extent{32, 25}, Extent{33, 27}}) {
    const Exemplar exemplar = test_exemplar(extent, 3);
    const Image p = periodic_component(exemplar.pixels);
    const Spectrum expected = forward_fft(p);
    const Spectrum z = forward_fft(fit_rpn(exemplar, {})->synthesize(torus(extent), Seed{1}));
    // The test's own transforms round in proportion to the largest coefficient, the mean's.
    const float rounding = 3e-7F * std::abs(expected.at(0, 0, 0));
    for (int c = 0; c < 3; ++c) {
      for (int ky = 0; ky < z.rows(); ++ky) {
        for (int kx = kx_start(ky); kx < z.columns(); ++kx) {
          ASSERT_NEAR(std::abs(z.at(c, kx, ky)), std::abs(expected.at(c, kx, ky)), rounding) << kx << " " << ky;
        }
      }
      EXPECT_NEAR(z.at(c, 0, 0).real(), expected.at(c, 0, 0).real(), 1e-6 * expected.at(c, 0, 0).real())
          << "the mean keeps its sign and size";
    }
  }
}

TEST(Rpn, KeepsThePhaseBetweenChannels) {
  const Exemplar exemplar = test_exemplar({32, 24}, 3);
  const Spectrum p = forward_fft(periodic_component(exemplar.pixels));
  const Spectrum z = forward_fft(fit_rpn(exemplar, {})->synthesize(torus({32, 24}), Seed{2}));
  for (int ky = 0; ky < z.rows(); ++ky) {
    for (int kx = kx_start(ky); kx < z.columns(); ++kx) {
      const auto before = std::conj(p.at(0, kx, ky)) * p.at(2, kx, ky);
      const auto after = std::conj(z.at(0, kx, ky)) * z.at(2, kx, ky);
      ASSERT_LT(std::abs(before - after), 1e-4F * std::abs(before) + 1e-4F);
    }
  }
}

TEST(Rpn, PhaseIsOddAndUniform) {
  // Lectures 2022: uniform off the self-conjugate bins and 0 or π with equal probability on them.
  for (const Extent extent : {Extent{8, 6}, Extent{7, 6}, Extent{8, 5}, Extent{9, 7}}) {
    const Exemplar exemplar = test_exemplar(extent, 1);
    const Spectrum p = forward_fft(periodic_component(exemplar.pixels));
    const auto model = fit_rpn(exemplar, {});
    std::vector<double> angles;
    int positive = 0;
    int real_bins = 0;
    for (std::uint64_t k = 0; k < 400; ++k) {
      const Spectrum z = forward_fft(model->synthesize(torus(extent), Seed{k}));
      for (int ky = 0; ky < z.rows(); ++ky) {
        for (int kx = kx_start(ky); kx < z.columns(); ++kx) {
          const std::complex<double> turn(z.at(0, kx, ky) / p.at(0, kx, ky));
          if (z.self_conjugate(kx, ky)) {
            ASSERT_NEAR(turn.imag(), 0, 1e-3);
            positive += turn.real() > 0 ? 1 : 0;
            ++real_bins;
          } else if (z.multiplicity(kx) == 2 || ky <= z.rows() / 2) {
            angles.push_back(std::arg(turn));
          }
        }
      }
    }
    // Threshold of false-alarm rate 1e-6 each.
    EXPECT_LT(kolmogorov_distance(angles, [](double a) { return a / (2 * std::numbers::pi) + 0.5; }), 2.7);
    if (real_bins > 0) {
      EXPECT_NEAR(positive, real_bins / 2.0, 4.9 * std::sqrt(real_bins) / 2);
    }
  }
}

TEST(Rpn, ReplacedPhaseKeepsTheModulusAndLosesTheColorCovariance) {
  // Channels that are shifted copies of each other: only their phase tells that the lag-zero covariance is small.
  Exemplar exemplar = test_exemplar({32, 32}, 3);
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) {
      exemplar.pixels.at(1, x, y) = exemplar.pixels.at(0, (x + 8) % 32, (y + 8) % 32);
    }
  }
  const auto right = fit_rpn(exemplar, {.component = SpotSource::raw});
  const auto wrong = fit_rpn(exemplar, {.component = SpotSource::raw, .phase = PhaseRule::replaced});
  const Eigen::MatrixXd target = color_covariance(gaussian_model(exemplar.pixels).spectrum);
  const auto covariance = [&](const Model& model) {
    return color_covariance(gaussian_model(model.synthesize(torus({32, 32}), Seed{4})).spectrum);
  };
  EXPECT_LT((covariance(*right) - target).norm(), 1e-5 * target.norm());
  const Eigen::MatrixXd of_wrong = covariance(*wrong);
  EXPECT_NEAR(of_wrong(0, 0), target(0, 0), 1e-5 * target(0, 0)) << "each channel alone is right";
  EXPECT_GT(std::abs(of_wrong(0, 1) - target(0, 1)), 0.3 * target(0, 0));
}

}  // namespace textonbench::rpn_test
