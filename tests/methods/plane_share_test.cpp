#include "methods/spot/plane_share.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "methods/base/random.h"

namespace textonbench::plane_share_test {

/// Corners at random and on both sides of every border, near the origin and far from it.
TEST(PlaneShare, BordersOfARampAreWhereItsKernelsChange) {
  RandomSequence random(Stream(Seed{1}));
  for (const double start : {0.0, -3.7, 0x1p30 + 0.1, -0x1p39}) {
    for (const double length : {1.0, 17.3, 512.0, 1e9}) {
      for (const int kernels : {2, 21, 256}) {
        const PlaneShare share = PlaneShare::ramp(start, length);
        const Extent box{31, 30};
        const std::vector<std::int64_t> borders = ramp_borders(share, box, kernels);
        ASSERT_EQ(borders.size(), static_cast<std::size_t>(kernels - 1));
        const auto expect_count = [&](std::int64_t corner) {
          const auto count = std::ranges::upper_bound(borders, corner) - borders.begin();
          ASSERT_EQ(count, kernel_with_corner(share, corner, 5, box, kernels)) << corner;
        };
        for (const std::int64_t border : borders) {
          for (const int step : {-1, 0, 1}) expect_count(border + step);
        }
        for (int i = 0; i < 100; ++i) {
          expect_count(std::llround((start + (1.4 * random.uniform() - 0.2) * length) * 0x1p22));
        }
      }
    }
  }
}

TEST(PlaneShare, BordersOfSharesAreWhereTheNearestKernelChanges) {
  RandomSequence random(Stream(Seed{2}));
  for (const int kernels : {2, 21, 255}) {
    const std::vector<std::uint32_t> borders = share_borders(kernels);
    const auto expect_count = [&](float share) {
      const auto count = std::ranges::upper_bound(borders, std::bit_cast<std::uint32_t>(share)) - borders.begin();
      ASSERT_EQ(count, PlaneShare::uniform(static_cast<double>(share)).kernel_at(0, 0, kernels)) << share;
    };
    for (const std::uint32_t border : borders) {
      expect_count(std::bit_cast<float>(border));
      expect_count(std::bit_cast<float>(border - 1));
    }
    for (int i = 0; i < 1000; ++i) expect_count(static_cast<float>(random.uniform()));
    expect_count(0);
    expect_count(1);
  }
}

TEST(PlaneShare, TellsTheShareOfEveryPoint) {
  EXPECT_EQ(PlaneShare::uniform(0.3).at(1e9, -5), 0.3);
  const PlaneShare ramp = PlaneShare::ramp(10, 40);
  EXPECT_EQ(ramp.at(9, 0), 0);
  EXPECT_EQ(ramp.at(20, 1e6), 0.25);
  EXPECT_EQ(ramp.at(51, 0), 1);
  Image picture({2, 1}, 1);
  picture.at(0, 1, 0) = 0.75F;
  const PlaneShare map = PlaneShare::map(picture);
  EXPECT_EQ(map.at(0.4, 7), 0);
  EXPECT_EQ(map.at(0.5, -7), 0.75);
  EXPECT_EQ(map.at(1e300, 0), 0.75);
}

TEST(PlaneShare, RefusesWhatIsNoShare) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(PlaneShare::uniform(1.1), std::invalid_argument);
  EXPECT_THROW(PlaneShare::uniform(nan), std::invalid_argument);
  EXPECT_THROW(PlaneShare::ramp(nan, 1), std::invalid_argument);
  EXPECT_THROW(PlaneShare::ramp(0, 0), std::invalid_argument);
  EXPECT_THROW(PlaneShare::map({}), std::invalid_argument);
  Image bad({2, 2}, 1);
  bad.at(0, 1, 1) = -0.1F;
  EXPECT_THROW(PlaneShare::map(bad), std::invalid_argument);
}

}  // namespace textonbench::plane_share_test
