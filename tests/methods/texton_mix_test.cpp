#include "methods/spot/texton_mix.h"

#include <gtest/gtest.h>

#include <Eigen/Core>

#include "tests/methods/plane_waves.h"

namespace textonbench::texton_mix_test {

constexpr int channels = 3;
constexpr int pixels = 400;

using Matrix = Eigen::MatrixXd;  // a column a kernel, a row a number of it

std::span<double> numbers(Matrix& kernels) { return {kernels.data(), static_cast<std::size_t>(kernels.size())}; }

/// Gaussian kernels of very different energies, two of them with a peak, correlated.
Matrix uneven_kernels(int count, std::uint64_t seed) {
  const std::vector<double> values =
      random_kernels(static_cast<std::size_t>(count * channels * pixels), count * channels * pixels, seed);
  Matrix kernels = Eigen::Map<const Matrix>(values.data(), channels * pixels, count);
  for (int k = 0; k < count; ++k) {
    kernels.col(k) *= std::pow(0.4, k);
  }
  kernels(17, 0) = 30;
  kernels(200, count - 1) = -20;
  if (count > 1) {
    kernels.col(1) += 0.3 * kernels.col(0);
  }
  return kernels;
}

double summed_kurtosis(const Matrix& kernels) {
  double sum = 0;
  for (int c = 0; c < channels; ++c) {
    const auto part = kernels.middleRows(c * pixels, pixels).array();
    sum += pixels * static_cast<double>(kernels.cols()) * part.pow(4).sum() / std::pow(part.square().sum(), 2);
  }
  return sum;
}

TEST(TextonMix, KeepsTheSpectrumAndEqualizesEnergies) {
  for (const int count : {1, 2, 3, 4, 7}) {
    const Matrix before = uneven_kernels(count, 3);
    Matrix after = before;
    mix_textons(numbers(after), count, channels);
    // Σ_k h_k(x) h_k(y) for all pairs of pixels and channels determines P.
    EXPECT_LT((after * after.transpose() - before * before.transpose()).cwiseAbs().maxCoeff(), 1e-10 * 900);
    const double mean = before.squaredNorm() / count;
    for (int k = 0; k < count; ++k) {
      EXPECT_NEAR(after.col(k).squaredNorm(), mean, 1e-6 * mean) << count << " kernels, " << k;
    }
    if (count > 1) {
      EXPECT_LT(summed_kurtosis(after), summed_kurtosis(before));
    }
  }
}

TEST(TextonMix, FindsALowKurtosisAmongTheEqualEnergies) {
  // Against the best of many mixes of equal energies that start from random rotations.
  for (const int count : {3, 4}) {
    const Matrix before = uneven_kernels(count, 4);
    Matrix after = before;
    mix_textons(numbers(after), count, channels);
    double best = std::numeric_limits<double>::infinity();
    double mean = 0;
    constexpr int trials = 30;
    for (std::uint64_t trial = 0; trial < trials; ++trial) {
      const std::vector<double> values = random_kernels(static_cast<std::size_t>(count * count), 1, 100 + trial);
      const Matrix random = Eigen::Map<const Matrix>(values.data(), count, count);
      const Matrix rotation = random.householderQr().householderQ();
      Matrix other = before * rotation;
      mix_textons(numbers(other), count, channels);
      best = std::min(best, summed_kurtosis(other));
      mean += summed_kurtosis(other) / trials;
    }
    EXPECT_LT(summed_kurtosis(after), 1.05 * best) << "mean of the others: " << mean;
  }
}

TEST(TextonMix, LeavesZeroKernelsAlone) {
  std::vector<double> zero(2 * channels * pixels);
  mix_textons(zero, 2, channels);
  EXPECT_EQ(zero, std::vector<double>(zero.size()));
}

}  // namespace textonbench::texton_mix_test
