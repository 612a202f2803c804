#include "methods/spot/certificate.h"

#include <gtest/gtest.h>

#include "methods/spot/lbfgs.h"
#include "methods/spot/optimal_texton.h"
#include "tests/methods/plane_waves.h"

namespace textonbench::certificate_test {

struct Case {
  Extent torus;
  Extent box;
  int channels;
  bool ragged;
};

// The third support is the whole torus; the fourth is so wide that its differences wrap around.
constexpr Case cases[] = {
    {{16, 15}, {7, 6}, 3, true}, {{30, 31}, {5, 5}, 1, false}, {{9, 8}, {9, 8}, 1, false}, {{10, 12}, {7, 4}, 3, true}};

Image mask_of(const Case& one) { return one.ragged ? ragged_mask(one.box) : full_mask(one.box); }

std::vector<double> optimized(const TransportObjective& objective, int kernels, int evaluations, std::uint64_t seed) {
  std::vector<double> x =
      random_kernels(static_cast<std::size_t>(kernels) * objective.support().size(), objective.variance(), seed);
  minimize_lbfgs([&](auto at, auto gradient) { return objective.evaluate(at, gradient); },
                 {.evaluations = evaluations, .first_step = objective.projection_step()}, x);
  return x;
}

/// Largest eigenvalue of M v = λ N v without the vectors that have no norm.
double dense_lambda(const PlaneWaves& waves, const Eigen::VectorXd& s) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> norm(waves.norm);
  Eigen::VectorXd scale = norm.eigenvalues();
  for (double& v : scale) {
    v = v > 1e-9 ? 1 / std::sqrt(v) : 0;
  }
  const Eigen::MatrixXd root = norm.eigenvectors() * scale.asDiagonal();
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(root.transpose() * waves.quotient(s) * root)
      .eigenvalues()
      .maxCoeff();
}

/// The overlap that certify uses, at the frequencies of PlaneWaves.
Eigen::VectorXd floored_overlap(const TransportObjective& objective, const std::vector<double>& kernels) {
  const Spectrum& target = objective.target();
  const std::vector<double> stored = objective.overlap(kernels);
  const auto [w, h] = target.raster();
  Eigen::VectorXd s(w * h - 1);
  Eigen::Index row = 0;
  for (int ky = 0; ky < h; ++ky) {
    for (int kx = ky == 0 ? 1 : 0; kx < w; ++kx, ++row) {
      const bool mirrored = kx >= target.columns();
      const int x = mirrored ? w - kx : kx;
      const int y = mirrored ? (h - ky) % h : ky;
      double energy = 0;
      for (int c = 0; c < target.channels(); ++c) {
        energy += std::norm(std::complex<double>(target.at(c, x, y)));
      }
      s[row] = std::max(stored[static_cast<std::size_t>(y * target.columns() + x)], overlap_floor * energy);
    }
  }
  return s;
}

TEST(Certificate, LambdaBoundsTheLargestEigenvalueOfADenseSolve) {
  for (const Case& one : cases) {
    const TransportObjective objective(spot_spectrum(one.torus, one.channels), mask_of(one));
    const PlaneWaves waves(objective.target(), mask_of(one));
    const std::vector<double> x = optimized(objective, 3, 40, 2);
    const Eigen::VectorXd s = floored_overlap(objective, x);
    const double exact = dense_lambda(waves, s);
    const Certificate found = certify(objective, x, {}, Seed{1});
    EXPECT_NEAR(found.ritz, exact, 2e-6 * exact);
    EXPECT_GE(found.lambda, exact);
    EXPECT_LT(found.lambda, (1 + 1e-4) * exact);
    EXPECT_NEAR(found.bound, std::max(0.0, 1 - exact * s.sum() / waves.energy), 2e-4);
  }
}

TEST(Certificate, FewStepsGiveAWeakerBoundNotAWrongOne) {
  const TransportObjective objective(spot_spectrum({40, 40}, 3), full_mask({9, 9}));
  const PlaneWaves waves(objective.target(), full_mask({9, 9}));
  const std::vector<double> x = optimized(objective, 3, 40, 2);
  const double exact = dense_lambda(waves, floored_overlap(objective, x));
  double last = std::numeric_limits<double>::infinity();
  for (const int steps : {1, 15, 60, 200, 1000}) {
    const double lambda = certify(objective, x, {.steps = steps}, Seed{1}).lambda;
    EXPECT_GE(lambda, exact) << steps;
    EXPECT_LE(lambda, last) << steps;
    last = lambda;
  }
  EXPECT_EQ(certify(objective, x, {.steps = 1}, Seed{1}).bound, 0) << "one step says nothing";
}

TEST(Certificate, NoTextonsGoBelowTheBound) {
  for (const Case& one : {cases[0], cases[1], cases[3]}) {
    const TransportObjective objective(spot_spectrum(one.torus, one.channels), mask_of(one));
    const PlaneWaves waves(objective.target(), mask_of(one));
    const double bound = certify(objective, optimized(objective, 6, 300, 1), {}, Seed{1}).bound;
    double lowest = 1;
    for (std::uint64_t trial = 0; trial < 200; ++trial) {
      const int kernels = 1 + static_cast<int>(trial % 5);
      std::vector<double> x = random_kernels(static_cast<std::size_t>(kernels) * objective.support().size(),
                                             objective.variance(), 1000 + trial);
      if (trial % 2 == 1) {
        x = optimized(objective, kernels, 5 + static_cast<int>(trial % 60), 1000 + trial);
      }
      Eigen::MatrixXd h = waves.columns(x);
      // At the best scale of these textons.
      h *= waves.overlap(h).sum() / (waves.pixels * (h.transpose() * waves.norm * h).trace());
      const double error = waves.squared_error(h);
      EXPECT_GE(error, bound) << trial;
      lowest = std::min(lowest, error);
    }
    EXPECT_LT(lowest - bound, 5e-4) << "and the bound is tight";
  }
}

/// The minimum over all positive semidefinite cross-covariances H H^T on the support, by as many kernels as there are
/// pixels and the fixed point H ← (M_s + J) H, with J = I − N: RME² falls in every step, and stationary points of full
/// rank are minima of the convex problem.
double dense_minimum(const PlaneWaves& waves) {
  const Eigen::Index n = waves.norm.rows();
  Eigen::MatrixXd h = std::sqrt(waves.energy / waves.pixels / static_cast<double>(n)) * Eigen::MatrixXd::Identity(n, n);
  const Eigen::MatrixXd constants = Eigen::MatrixXd::Identity(n, n) - waves.norm;
  double error = waves.squared_error(h);
  for (int step = 0; step < 20000; ++step) {
    h = (waves.quotient(waves.overlap(h)) + constants) * h;
    if (step % 500 == 499) {
      const double now = waves.squared_error(h);
      EXPECT_LE(now, error + 1e-12);
      if (error - now < 1e-10) {
        return now;
      }
      error = now;
    }
  }
  return error;
}

TEST(Certificate, FoundMinimumAndBoundEncloseTheDenseSolutionOfTheConvexProblem) {
  for (const Case& one :
       {Case{{12, 10}, {3, 3}, 1, false}, Case{{12, 11}, {4, 4}, 1, true}, Case{{10, 9}, {3, 2}, 3, false}}) {
    const TransportObjective objective(spot_spectrum(one.torus, one.channels), mask_of(one));
    const PlaneWaves waves(objective.target(), mask_of(one));
    const double minimum = dense_minimum(waves);
    const std::vector<double> x = optimized(objective, 6, 1000, 1);
    std::vector<double> gradient(x.size());
    const double found = objective.evaluate(x, gradient);
    const double bound = certify(objective, x, {}, Seed{1}).bound;
    EXPECT_NEAR(found, minimum, 1e-5);
    EXPECT_LE(bound, minimum);
    EXPECT_GT(bound, minimum - 3e-4);
  }
}

TEST(Certificate, RefusesOptionsOutOfRange) {
  const TransportObjective objective(spot_spectrum({10, 8}, 1), full_mask({3, 3}));
  const std::vector<double> x = random_kernels(objective.support().size(), objective.variance(), 1);
  EXPECT_THROW(certify(objective, x, {.steps = 0}, Seed{1}), std::invalid_argument);
  EXPECT_THROW(certify(objective, x, {.failure_probability = 0}, Seed{1}), std::invalid_argument);
  EXPECT_THROW(certify(objective, x, {.failure_probability = 1}, Seed{1}), std::invalid_argument);
}

TEST(Certificate, OneTextonProvesNothingAboutMany) {
  const GaussianModel model = gaussian_model(test_texture({48, 40}, 3));
  const Image mask = full_mask({9, 9});
  const TransportObjective objective(model.spectrum.factors.front(), mask);
  const double of_one = certify(objective, optimized(objective, 1, 200, 3), {}, Seed{1}).bound;
  const double of_eight = certify(objective, optimized(objective, 8, 200, 3), {}, Seed{1}).bound;
  EXPECT_LT(of_one, of_eight - 0.01);
}

}  // namespace textonbench::certificate_test
