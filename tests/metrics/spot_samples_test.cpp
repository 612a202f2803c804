#include "experiments/metrics/spot_samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "methods/base/spectrum.h"
#include "tests/texton.h"

namespace textonbench::spot_samples_test {

TEST(RawSpotNoise, SumsTheSameImpactsWhateverTheKernel) {
  Image point(Extent{3, 2}, 1);
  point.at(0, 0, 0) = 1;
  Image shifted(Extent{3, 2}, 1);
  shifted.at(0, 2, 1) = 2;
  const Stream stream = Stream(Seed{1}).child("impacts");
  const Image counts = raw_spot_noise(point, 0.3, stream, {40, 30});
  const Image moved = raw_spot_noise(shifted, 0.3, stream, {40, 30});
  for (int y = 1; y < 30; ++y) {
    for (int x = 2; x < 40; ++x) EXPECT_EQ(moved.at(0, x, y), 2 * counts.at(0, x - 2, y - 1));
  }
  // 1200 pixels of variance 0.3: five standard errors, false-alarm rate 6e-7.
  EXPECT_NEAR(channel_means(counts).front(), 0.3, 5 * std::sqrt(0.3 / 1200));
}

TEST(RawSpotNoise, AWindowOfOnePixelIsTheCornerOfALargerOne) {
  const Texton texton = test_texton({5, 4}, 3, 1);
  const Stream stream = Stream(Seed{2}).child("impacts");
  const Image one = raw_spot_noise(texton.kernels.front(), 0.5, stream, {1, 1});
  const Image many = raw_spot_noise(texton.kernels.front(), 0.5, stream, {17, 9});
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(one.at(c, 0, 0), many.at(c, 0, 0), 1e-6);
}

TEST(LagProducts, AreTheAveragesOverPairs) {
  const Image u = test_texton({13, 11}, 3, 1).kernels.front();
  const std::vector<float> products = lag_products(u, 6);
  std::size_t entry = 0;
  for (int c = 0; c < 3; ++c) {
    for_each_lag(6, [&](int x, int y) {
      const double pairs = (13 - std::abs(x)) * (11 - y);
      EXPECT_NEAR(products[entry++], autocorrelation(u, c, x, y) / pairs, 1e-6) << c << " " << x << " " << y;
    });
  }
  EXPECT_EQ(entry, products.size());
}

TEST(Autocorrelation, IsTheSumOverTheOverlap) {
  const Image h = test_texton({4, 3}, 1, 1).kernels.front();
  double sum = 0;
  for (int x = 0; x < 3; ++x) sum += static_cast<double>(h.at(0, x + 1, 2)) * static_cast<double>(h.at(0, x, 0));
  EXPECT_NEAR(autocorrelation(h, 0, 1, 2), sum, 1e-12);
  EXPECT_NEAR(autocorrelation(h, 0, -1, -2), sum, 1e-12);
  EXPECT_EQ(autocorrelation(h, 0, 4, 0), 0);
  EXPECT_EQ(autocorrelation(h, 0, -1, 3), 0);
}

}  // namespace textonbench::spot_samples_test
