// Sums of powers of kernels, and the pursuit that finds them, against dense matrices.
#include "methods/sparse/gabor_pursuit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <numbers>

#include "methods/sparse/gabor_spectrum.h"

namespace textonbench {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr int pursuit_side = 16;
constexpr int pursuit_bins = pursuit_side * pursuit_side;

/// Windows whose powers have deviations of 0.7 and 2 bins.
const std::vector<GaborWindow>& pursuit_windows() {
  static const std::vector<GaborWindow> windows = [] {
    std::vector<GaborWindow> all;
    for (const double deviation : {0.7, 2.0}) {
      all.push_back(GaborWindow::round(2 * std::sqrt(std::numbers::pi) * deviation / pursuit_side, 0.001));
    }
    return all;
  }();
  return windows;
}

const GaborDictionary& small_dictionary() {
  static const GaborDictionary dictionary({pursuit_side, pursuit_side}, pursuit_windows());
  return dictionary;
}

/// Column (b, F): the transform of the correlation with folded lags, cosine by cosine.
Eigen::MatrixXd dense_dictionary() {
  Eigen::MatrixXd dense(pursuit_bins, 2 * pursuit_bins);
  for (int b = 0; b < 2; ++b) {
    const GaborWindow& window = pursuit_windows()[static_cast<std::size_t>(b)];
    const GaborCorrelation correlation(window);
    Eigen::MatrixXd atom = Eigen::MatrixXd::Zero(pursuit_side, pursuit_side);
    constexpr int reach = 64;
    for (int y = -reach; y <= reach; ++y) {
      for (int x = -reach; x <= reach; ++x) {
        const double lag = correlation.at(x, y) / window.energy() / pursuit_bins;
        if (lag <= 0) continue;
        for (int i = 0; i < pursuit_bins; ++i) {
          const int kx = i % pursuit_side, ky = i / pursuit_side;
          atom(ky, kx) += lag * std::cos(2 * std::numbers::pi * (kx * x + ky * y) / pursuit_side);
        }
      }
    }
    for (int f = 0; f < pursuit_bins; ++f) {
      for (int i = 0; i < pursuit_bins; ++i) {
        const int kx = (i % pursuit_side - f % pursuit_side + pursuit_side) % pursuit_side;
        const int ky = (i / pursuit_side - f / pursuit_side + pursuit_side) % pursuit_side;
        dense(i, b * pursuit_bins + f) = atom(ky, kx);
      }
    }
  }
  return dense;
}

Eigen::VectorXd flat(const Image& image) {
  Eigen::VectorXd all(image.channels() * pursuit_bins);
  for (int i = 0; i < all.size(); ++i) {
    all[i] = image.at(i / pursuit_bins, i % pursuit_side, i % pursuit_bins / pursuit_side);
  }
  return all;
}

Image pursuit_image(const Eigen::VectorXd& all) {
  const int channels = static_cast<int>(all.size()) / pursuit_bins;
  Image image({pursuit_side, pursuit_side}, channels);
  for (int i = 0; i < all.size(); ++i) {
    image.at(i / pursuit_bins, i % pursuit_side, i % pursuit_bins / pursuit_side) = static_cast<float>(all[i]);
  }
  return image;
}

int opposite(int bin) {
  const int x = (pursuit_side - bin % pursuit_side) % pursuit_side;
  const int y = (pursuit_side - bin / pursuit_side) % pursuit_side;
  return y * pursuit_side + x;
}

/// Even and uniform in [0, 1).
Eigen::VectorXd even_numbers(std::uint64_t seed) {
  Eigen::VectorXd all(pursuit_bins);
  for (int i = 0; i < pursuit_bins; ++i) {
    all[i] = philox_block(seed, 0, static_cast<std::uint64_t>(std::min(i, opposite(i))))[0] * 0x1p-32;
  }
  return all;
}

/// Three kernels and noise.
Eigen::VectorXd noisy_power(const Eigen::MatrixXd& dense) {
  Eigen::VectorXd planted = Eigen::VectorXd::Zero(2 * pursuit_bins);
  for (const int bin : {3 + 2 * pursuit_side, 6 + 12 * pursuit_side}) {
    planted[bin] = planted[opposite(bin)] = 4;
    planted[pursuit_bins + bin - 1] = planted[pursuit_bins + opposite(bin - 1)] = 9;
  }
  return dense * planted + 0.05 * even_numbers(5);
}

TEST(GaborDictionary, SumsAndCorrelatesAsADenseMatrix) {
  const Eigen::MatrixXd dense = dense_dictionary();
  Eigen::VectorXd c(2 * pursuit_bins);
  c << even_numbers(1), even_numbers(2);
  const Eigen::VectorXd r = even_numbers(3);
  EXPECT_LT((flat(small_dictionary().sum(pursuit_image(c))) - dense * c).cwiseAbs().maxCoeff(), 1e-5);
  EXPECT_LT((flat(small_dictionary().correlate(pursuit_image(r))) - dense.transpose() * r).cwiseAbs().maxCoeff(), 1e-5);
  EXPECT_GT(dense.minCoeff(), -1e-6) << "powers are not negative, but for the window's correlation being in a table";
  for (int b = 0; b < 2; ++b) EXPECT_NEAR(small_dictionary().norm(b), dense.col(b * pursuit_bins).norm(), 1e-5);
}

TEST(GaborDictionary, CentersAreEvenAndAsFarApartAsADeviation) {
  int centers = 0;
  for (int i = 0; i < pursuit_bins; ++i) {
    const int x = i % pursuit_side, y = i / pursuit_side;
    EXPECT_TRUE(small_dictionary().is_center(0, x, y));
    centers += small_dictionary().is_center(1, x, y);
    EXPECT_EQ(small_dictionary().is_center(1, x, y),
              small_dictionary().is_center(1, opposite(i) % pursuit_side, opposite(i) / pursuit_side));
  }
  EXPECT_EQ(centers, pursuit_bins / 4);
}

/// Cyclic coordinate descent on the same problem.
TEST(PenalizedCoefficients, AreThoseOfADenseSolver) {
  const Eigen::MatrixXd dense = dense_dictionary();
  const Eigen::VectorXd p = noisy_power(dense);
  for (const PursuitResidual residual : {PursuitResidual::power, PursuitResidual::transport}) {
    Eigen::VectorXd squared = Eigen::VectorXd::Ones(pursuit_bins);  // m²
    if (residual == PursuitResidual::transport) {
      const Eigen::VectorXd smooth = dense.rightCols(pursuit_bins).transpose() * p;
      squared = (smooth.maxCoeff() / smooth.array()).min(1e5);
    }
    squared[0] = 0;
    Eigen::VectorXd norm(2 * pursuit_bins), c = Eigen::VectorXd::Zero(2 * pursuit_bins);
    Eigen::VectorXd curvature(2 * pursuit_bins);
    double most = 0;
    for (int j = 0; j < norm.size(); ++j) {
      norm[j] = dense.col(j).norm();
      curvature[j] = dense.col(j).cwiseAbs2().dot(squared);
      const int bin = j % pursuit_bins;
      if (!small_dictionary().is_center(j / pursuit_bins, bin % pursuit_side, bin / pursuit_side)) curvature[j] = 0;
      if (curvature[j] > 0) most = std::max(most, dense.col(j).dot(squared.cwiseProduct(p)) / norm[j]);
    }
    const double lambda = 0.05 * most;
    Eigen::VectorXd left = p;  // p − D c
    for (int sweep = 0; sweep < 3000; ++sweep) {
      for (int j = 0; j < norm.size(); ++j) {
        if (curvature[j] == 0) continue;
        const double slope = dense.col(j).dot(squared.cwiseProduct(left)) - lambda * norm[j];
        const double fresh = std::max(0.0, c[j] + slope / curvature[j]);
        left -= (fresh - c[j]) * dense.col(j);
        c[j] = fresh;
      }
    }
    const Eigen::VectorXd found = flat(penalized_coefficients(small_dictionary(), pursuit_image(p),
                                                              {.residual = residual, .iterations = 20000}, 0.05, 1e-7));
    EXPECT_GT((c.array() == 0).count(), pursuit_bins) << "the solution is sparse";
    EXPECT_LT((found - c).norm(), 2e-3 * c.norm());
  }
}

TEST(Pursuit, FindsPlantedKernels) {
  const Eigen::MatrixXd dense = dense_dictionary();
  const Eigen::VectorXd p = noisy_power(dense);
  const Pursuit found = pursue(small_dictionary(), pursuit_image(p), {.noise = 0.05, .iterations = 5000});
  EXPECT_EQ(found.reason, "tolerance");
  EXPECT_LE(found.residual, 0.05);
  EXPECT_LT(found.rme.back(), 0.3);
  const Eigen::VectorXd c = flat(found.coefficients);
  EXPECT_GE(c.minCoeff(), 0);
  EXPECT_NEAR((dense * c).sum(), p.sum(), 0.02 * p.sum()) << "but for bin 0, which is left out";
  for (int j = 0; j < c.size(); ++j) {
    EXPECT_NEAR(c[j], c[j / pursuit_bins * pursuit_bins + opposite(j % pursuit_bins)], 1e-3);
  }
}

TEST(Pursuit, SaysWhenItDoesNotConverge) {
  const Pursuit found =
      pursue(small_dictionary(), pursuit_image(noisy_power(dense_dictionary())), {.noise = 0.05, .iterations = 5});
  EXPECT_EQ(found.reason, "iterations");
  EXPECT_EQ(found.rme.size(), 6U) << "five iterations, and the end";
}

TEST(Pursuit, TellsWhatIsNoPower) {
  const auto pursue_power = [](const Eigen::VectorXd& p) {
    return [=] { static_cast<void>(pursue(small_dictionary(), pursuit_image(p), {})); };
  };
  Eigen::VectorXd p = even_numbers(4);
  p[7] = -1;
  EXPECT_THAT(pursue_power(p), ThrowsMessage<std::invalid_argument>(HasSubstr("-1 at bin (7, 0)")));
  p[7] = std::numeric_limits<double>::infinity();
  EXPECT_THAT(pursue_power(p), ThrowsMessage<std::invalid_argument>(HasSubstr("at bin (7, 0)")));
  p[7] = 100;
  EXPECT_THAT(pursue_power(p), ThrowsMessage<std::invalid_argument>(HasSubstr("odd part")));
  EXPECT_THAT(pursue_power(Eigen::VectorXd::Zero(pursuit_bins)),
              ThrowsMessage<std::invalid_argument>(HasSubstr("zero everywhere")));
}

}  // namespace
}  // namespace textonbench
