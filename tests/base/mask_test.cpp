// Sets of pixels, held against definitions by loops over all pairs.
#include "methods/base/mask.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <limits>
#include <stdexcept>

#include "methods/base/random.h"

namespace textonbench::mask_test {

Mask random_mask(Extent extent, int one_in, std::uint64_t seed) {
  RandomSequence sequence{Stream(Seed{seed})};
  Mask mask(extent);
  for (int y = 0; y < extent.height; ++y) {
    for (int x = 0; x < extent.width; ++x) mask.set(x, y, sequence.below(static_cast<std::uint64_t>(one_in)) == 0);
  }
  return mask;
}

int distance_along(int a, int b, int side, bool torus) {
  const int straight = std::abs(a - b);
  return torus ? std::min(straight, side - straight) : straight;
}

/// By the definition.
Mask dilated_by_pairs(const Mask& mask, int distance, bool torus) {
  const auto [width, height] = mask.extent();
  Mask result(mask.extent());
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (const Pixel& p : pixels_of(mask)) {
        const int far = std::max(distance_along(x, p.x, width, torus), distance_along(y, p.y, height, torus));
        if (far <= distance) result.set(x, y, true);
      }
    }
  }
  return result;
}

TEST(MaskTest, IsEmptyOrFullAndCounts) {
  Mask mask({5, 3});
  EXPECT_EQ(mask.count(), 0);
  mask.set(4, 2, true);
  mask.set(0, 1, true);
  mask.set(0, 1, true);
  EXPECT_EQ(mask.count(), 2);
  EXPECT_TRUE(mask.at(4, 2));
  mask.set(4, 2, false);
  EXPECT_EQ(mask.count(), 1);
  EXPECT_EQ(Mask({5, 3}, true).count(), 15);
  EXPECT_EQ(Mask().count(), 0);
  EXPECT_EQ(Mask(), Mask());
  EXPECT_NE(mask, Mask({5, 3}));
}

TEST(MaskTest, RefusesSidesOfNoPixel) {
  for (const Extent extent : {Extent{0, 3}, Extent{3, 0}, Extent{-1, 2}}) {
    EXPECT_THAT([&] { Mask mask(extent); },
                testing::ThrowsMessage<std::invalid_argument>(testing::HasSubstr("at least 1")));
  }
}

TEST(MaskTest, DilationIsThatOfTheDefinition) {
  int masks = 0;
  for (const Extent extent : {Extent{1, 1}, Extent{1, 9}, Extent{12, 1}, Extent{7, 5}, Extent{16, 13}}) {
    for (const int one_in : {1, 6, 60}) {
      const Mask mask = random_mask(extent, one_in, static_cast<std::uint64_t>(++masks));
      for (const int distance : {0, 1, 2, 3, 6, 8, 40, std::numeric_limits<int>::max()}) {
        for (const bool torus : {false, true}) {
          ASSERT_EQ(dilate(mask, distance, torus), dilated_by_pairs(mask, distance, torus))
              << extent.width << 'x' << extent.height << ", one in " << one_in << ", distance " << distance
              << (torus ? ", torus" : "");
        }
      }
    }
  }
}

TEST(MaskTest, DilationOfOnePixelIsASquare) {
  Mask mask({11, 9});
  mask.set(1, 4, true);
  const Mask grown = dilate(mask, 2);
  EXPECT_EQ(grown.count(), 4 * 5);
  EXPECT_TRUE(grown.at(3, 6));
  EXPECT_FALSE(grown.at(4, 6));
  const Mask around = dilate(mask, 2, true);
  EXPECT_EQ(around.count(), 5 * 5);
  EXPECT_TRUE(around.at(10, 2));
}

TEST(MaskTest, DilationOfNothingIsNothing) {
  EXPECT_EQ(dilate(Mask({6, 4}), 100).count(), 0);
  EXPECT_EQ(dilate(Mask({6, 4}), 100, true).count(), 0);
}

TEST(MaskTest, DilationRefusesANegativeDistance) {
  EXPECT_THAT(
      [] {
        dilate(Mask({2, 2}), -1);
      },
      testing::ThrowsMessage<std::invalid_argument>(testing::HasSubstr("distance -1")));
}

// A square of side 2 distance + 1 would be visited a pixel otherwise: a hundred thousand times as long.
TEST(MaskTest, DilationTakesNoLongerForALongDistance) {
  const Mask mask = random_mask({1024, 1024}, 1000, 7);
  const auto seconds = [&](int distance) {
    const auto start = std::chrono::steady_clock::now();
    EXPECT_GT(dilate(mask, distance).count(), mask.count());
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  seconds(1);
  EXPECT_LT(seconds(150), 20 * seconds(1));
}

TEST(MaskTest, DifferenceIsWhatIsInTheFirstAlone) {
  const Mask a = random_mask({9, 8}, 2, 1);
  const Mask b = random_mask({9, 8}, 2, 2);
  const Mask only = difference(a, b);
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 9; ++x) EXPECT_EQ(only.at(x, y), a.at(x, y) && !b.at(x, y));
  }
  EXPECT_THAT(
      [&] {
        difference(a, Mask({8, 9}));
      },
      testing::ThrowsMessage<std::invalid_argument>(
          testing::AllOf(testing::HasSubstr("9x8"), testing::HasSubstr("8x9"))));
}

TEST(MaskTest, PixelsAreRowByRow) {
  Mask mask({4, 3});
  mask.set(2, 0, true);
  mask.set(1, 2, true);
  mask.set(3, 2, true);
  EXPECT_THAT(pixels_of(mask), testing::ElementsAre(Pixel{2, 0}, Pixel{1, 2}, Pixel{3, 2}));
  EXPECT_THAT(pixels_of(Mask({4, 3})), testing::IsEmpty());
}

TEST(MaskTest, BoundingBoxHoldsAllPixelsTightly) {
  const std::vector<Pixel> pixels{{5, 9}, {3, 11}, {8, 10}};
  EXPECT_EQ(bounding_box(pixels), (Rectangle{3, 9, {6, 3}}));
  EXPECT_EQ(bounding_box(std::vector<Pixel>{{7, 2}}), (Rectangle{7, 2, {1, 1}}));
  EXPECT_THROW(bounding_box({}), std::invalid_argument);
}

}  // namespace textonbench::mask_test
