#include "methods/spot/kernel_moments.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/texture.h"

namespace textonbench::kernel_moments_test {

Texton flat_texton(int side) {
  Texton texton;
  texton.kernels.emplace_back(Extent{side, side}, 1);
  for (int y = 0; y < side; ++y) {
    for (float& v : texton.kernels[0].row(0, y)) v = 0.5F;
  }
  texton.support_pixels = texton.extent().area();
  texton.mean = {0.5};
  return texton;
}

Texton noise_texton(Extent extent, int kernels, bool gaussian_values) {
  Texton texton;
  for (int k = 0; k < kernels; ++k) {
    Image& kernel = texton.kernels.emplace_back(extent, 1);
    for (int y = 0; y < extent.height; ++y) {
      fill_normal(Stream(Seed{7}).child(static_cast<std::uint64_t>(k)), static_cast<std::uint64_t>(y), 0,
                  kernel.row(0, y));
      for (float& v : kernel.row(0, y)) v = gaussian_values ? v : std::fabs(v);
    }
  }
  texton.support_pixels = extent.area();
  texton.mean = {0.0};
  return texton;
}

TEST(KernelMoments, OfAFlatKernelAreThoseOfAPoissonNumber) {
  // The sum is a scaled Poisson number of mean MNI: skewness 1 / sqrt(MNI), excess kurtosis 1 / MNI.
  for (const double mni : {1.0, 30.0, 1000.0}) {
    const NoiseMoments moments = poisson_moments(flat_texton(9), mni)[0];
    EXPECT_NEAR(moments.skewness, 1 / std::sqrt(mni), 1e-9);
    EXPECT_NEAR(moments.excess_kurtosis, 1 / mni, 1e-9);
  }
}

TEST(KernelMoments, KurtosisOfGaussianKernelsIsThreeWhateverTheirNumber) {
  for (const int kernels : {1, 2, 4}) {
    EXPECT_NEAR(poisson_moments(noise_texton({60, 60}, kernels, true), 1)[0].excess_kurtosis, 3,
                5 * std::sqrt(24.0 / (3600 * kernels)));
  }
  Texton flat_channel = noise_texton({4, 4}, 1, true);
  flat_channel.kernels[0] = Image({4, 4}, 1);
  EXPECT_EQ(poisson_moments(flat_channel, 1)[0].excess_kurtosis, 0) << "a channel without variation";
}

TEST(KernelMoments, CellDifferenceLawIsThatOfAllItsCells) {
  for (const CellAxis axis : {CellAxis{3 * 1024, 1024}, CellAxis{17, 5}, CellAxis{5, 7}, CellAxis{40, 40},
                              CellAxis{1536, 1024}, CellAxis{64, 1024}, CellAxis{1, 1024}}) {
    std::vector<double> law(static_cast<std::size_t>(axis.numerator / axis.denominator + 2));
    for (std::int64_t cell = 0; cell < axis.denominator; ++cell) {
      std::vector<double> pixels(law.size());
      const std::int64_t corner = cell * axis.numerator / axis.denominator;
      for (std::int64_t step = 0; step < axis.numerator; ++step) {
        const std::int64_t pixel = (cell * axis.numerator + step) / axis.denominator;
        pixels[static_cast<std::size_t>(pixel - corner)] += 1 / static_cast<double>(axis.numerator);
      }
      for (std::size_t v = 0; v < law.size(); ++v) {
        for (std::size_t i = 0; i + v < pixels.size(); ++i) {
          law[v] += pixels[i] * pixels[i + v] / static_cast<double>(axis.denominator);
        }
      }
    }
    const std::vector<double> found = cell_difference_law(axis);
    ASSERT_LE(found.size(), law.size());
    for (std::size_t v = 0; v < law.size(); ++v) {
      EXPECT_NEAR(v < found.size() ? found[v] : 0, law[v], 1e-12) << axis.numerator << "/" << axis.denominator;
    }
  }
}

/// The average over the torus of Σ_c [E g⁴ − 3 (E g²)²] / λ² / variance², cell by cell and pixel by pixel.
double enumerated_excess(const Texton& texton, const CellLattice& lattice, Extent torus) {
  const auto kernels = static_cast<double>(texton.kernels.size());
  double variance = 0;
  for (const Image& kernel : texton.kernels) {
    for (int y = 0; y < kernel.height(); ++y) {
      for (const double v : kernel.row(0, y)) variance += v * v;
    }
  }
  double sum = 0;
  for (int x = 0; x < torus.width; ++x) {
    for (int y = 0; y < torus.height; ++y) {
      for (std::int64_t cx = 0; cx < lattice.x.denominator; ++cx) {
        for (std::int64_t cy = 0; cy < lattice.y.denominator; ++cy) {
          double second = 0;
          double fourth = 0;
          const double points = static_cast<double>(lattice.x.numerator * lattice.y.numerator);
          for (std::int64_t i = 0; i < lattice.x.numerator; ++i) {
            for (std::int64_t j = 0; j < lattice.y.numerator; ++j) {
              const auto px = static_cast<int>((cx * lattice.x.numerator + i) / lattice.x.denominator);
              const auto py = static_cast<int>((cy * lattice.y.numerator + j) / lattice.y.denominator);
              const int kx = (x - px + torus.width) % torus.width;
              const int ky = (y - py + torus.height) % torus.height;
              if (kx >= texton.extent().width || ky >= texton.extent().height) continue;
              for (const Image& kernel : texton.kernels) {
                const double g2 = kernels * std::pow(static_cast<double>(kernel.at(0, kx, ky)), 2);
                second += g2 / kernels / points;
                fourth += g2 * g2 / kernels / points;
              }
            }
          }
          sum += fourth - 3 * second * second;
        }
      }
    }
  }
  const double intensity = lattice.intensity();
  return sum / (static_cast<double>(torus.area()) * intensity * intensity * variance * variance);
}

TEST(KernelMoments, StratifiedIsTheAverageOverTheLattice) {
  // The torus is larger than twice the kernels, so lags do not wrap.
  const Extent torus{13, 11};
  for (const int kernels : {1, 2}) {
    const Texton texton = noise_texton({5, 4}, kernels, true);
    const StratifiedMoments moments(texton);
    for (const double intensity : {0.04, 0.1, 0.3, 1.2}) {
      const CellLattice lattice = torus_lattice(intensity, torus);
      const double expected = enumerated_excess(texton, lattice, torus);
      EXPECT_NEAR(moments.on(lattice)[0].excess_kurtosis, expected, 2e-5 * (1 + std::fabs(expected))) << intensity;
      EXPECT_EQ(moments.on(lattice)[0].skewness, 0);
    }
  }
}

TEST(KernelMoments, LocalKurtosisSurroundsItsAverage) {
  // Where the cells are whole pixels, the sampled ones are all there are: a kernel of one pixel is in one cell, and its
  // kurtosis is the same everywhere; one as large as a cell meets one to four.
  const CellLattice lattice = plane_lattice(1.0 / 16);
  const Texton pixel = noise_texton({1, 1}, 1, true);
  const KurtosisRange same = StratifiedMoments(pixel).range_on(lattice)[0];
  EXPECT_NEAR(same.least, same.greatest, 1e-12);
  EXPECT_NEAR(same.least, StratifiedMoments(pixel).on(lattice)[0].excess_kurtosis, 1e-5);
  EXPECT_NEAR(same.least, 16 - 3, 1e-9);
  const Texton flat = flat_texton(4);
  const KurtosisRange found = StratifiedMoments(flat).range_on(lattice)[0];
  EXPECT_NEAR(found.least, 1 - 3, 1e-9) << "the kernel fills one cell";
  EXPECT_NEAR(found.greatest, 1 - 3.0 / 4, 1e-9) << "a quarter of each of four cells";
  const double average = StratifiedMoments(flat).on(lattice)[0].excess_kurtosis;
  EXPECT_TRUE(average > found.least && average < found.greatest);
}

TEST(KernelMoments, FewStratifiedImpactsDoForAFeaturelessTexton) {
  const Texton texton = noise_texton({31, 31}, 1, true);
  const double poisson = poisson_impacts_needed(texton, 0.1);
  const double stratified = stratified_impacts_needed(texton, 0.1);
  EXPECT_NEAR(poisson, 30, 2);  // Σh⁴ |S| / (Σh²)² = 3 of Gaussian values
  EXPECT_LT(stratified, 0.3 * poisson);
  EXPECT_LT(std::fabs(StratifiedMoments(texton).on(plane_lattice(stratified / 961))[0].excess_kurtosis), 0.1);
  EXPECT_NEAR(poisson_moments(texton, poisson)[0].excess_kurtosis, 0.1, 1e-9);
}

TEST(KernelMoments, AnImpulseGainsNothing) {
  // One value other than zero: κ_h = |S|, and a cell that covers many pixels leaves nearly all of it.
  Texton texton = flat_texton(15);
  texton.kernels[0] = Image({15, 15}, 1);
  texton.kernels[0].at(0, 7, 7) = 1;
  const double poisson = poisson_moments(texton, 1)[0].excess_kurtosis;
  EXPECT_NEAR(poisson, 225, 1e-9);
  EXPECT_GT(StratifiedMoments(texton).on(plane_lattice(1.0 / 225))[0].excess_kurtosis, 0.98 * poisson);
}

}  // namespace textonbench::kernel_moments_test
