#include "methods/spot/spot_sum.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "tests/texton.h"

namespace textonbench::spot_sum_test {

/// The sum as it is written down, in double precision.
double naive_sum(const std::vector<Image>& kernels, const ImpactSet& set, const SumDomain& domain, int c, int x,
                 int y) {
  const auto [width, height] = kernels.front().extent();
  double sum = 0;
  for (const ImpactStrip& strip : set.strips) {
    for (const Impact& impact : strip.impacts) {
      int i = x - impact.x + (domain.periodic ? 0 : width - 1);
      int j = y - impact.y + (domain.periodic ? 0 : height - 1);
      if (domain.periodic) {
        i = (i + domain.size.width) % domain.size.width;
        j = (j + domain.size.height) % domain.size.height;
      }
      if (i >= 0 && i < width && j >= 0 && j < height) {
        sum += impact.weight * kernels[static_cast<std::size_t>(impact.kernel)].at(c, i, j);
      }
    }
  }
  for (const Image& kernel : kernels) {
    for (int j = 0; j < height; ++j) {
      for (int i = 0; i < width; ++i) sum -= set.mean_weight * kernel.at(c, i, j);
    }
  }
  return sum;
}

TEST(SpotSum, BothRoutesAreTheSumOverTheImpacts) {
  // Thousands of small images: threads would wait for each other.
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  for (const int kernel_count : {1, 3}) {
    for (const bool periodic : {true, false}) {
      for (const double intensity : {0.003, 0.2, 6.0}) {
        for (const bool stratified : {true, false}) {
          const Texton texton = test_texton({13, 9}, 3, kernel_count);
          const SpotKernels kernels(texton.kernels);
          const SumDomain domain{{40, 37}, periodic};
          const PlaneWindow window = periodic ? PlaneWindow{0, 0, domain.size} : PlaneWindow{-70, 1000, {52, 45}};
          const CellLattice lattice = periodic ? torus_lattice(intensity, domain.size) : plane_lattice(intensity);
          const ImpactSet set = stratified ? draw_stratified(Stream(Seed{3}), lattice, kernel_count, window)
                                           : draw_poisson(Stream(Seed{3}), intensity, kernel_count, window);
          ASSERT_GT(set.size(), 0);
          const Image direct = sum_direct(kernels, set, 0.7, texton.mean, domain);
          const Image spectral = sum_spectral(kernels, set, 0.7, texton.mean, domain);
          const double deviation = 0.7 * std::sqrt(intensity * 13 * 9) * 0.12;
          for (int c = 0; c < 3; ++c) {
            for (int y = 0; y < 37; ++y) {
              for (int x = 0; x < 40; ++x) {
                const double expected =
                    texton.mean[static_cast<std::size_t>(c)] + 0.7 * naive_sum(texton.kernels, set, domain, c, x, y);
                ASSERT_NEAR(direct.at(c, x, y), expected, 5e-6 * (1 + deviation)) << x << " " << y;
                ASSERT_NEAR(spectral.at(c, x, y), expected, 5e-6 * (1 + deviation)) << x << " " << y;
              }
            }
          }
        }
      }
    }
  }
}

TEST(SpotSum, KernelsAreCroppedToWhatIsNotZero) {
  const SpotKernels kernels(disc_texton(4, 3).kernels);
  EXPECT_EQ(kernels.extent(), (Extent{9, 9}));
  EXPECT_EQ(kernels.span_pixels, 49);  // points of Z² within 4 of the origin
  EXPECT_EQ(kernels.spans[0][0].first, 4);
  EXPECT_EQ(kernels.spans[0][0].end, 5);
}

}  // namespace textonbench::spot_sum_test
