#include "methods/base/image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <utility>

namespace textonbench::image_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

bool aligned(const float* pointer) { return reinterpret_cast<std::uintptr_t>(pointer) % 64 == 0; }

/// Sample c * 10000 + y * 100 + x.
Image numbered(Extent extent, int channels) {
  Image image(extent, channels);
  for (int c = 0; c < channels; ++c) {
    for (int y = 0; y < extent.height; ++y) {
      for (int x = 0; x < extent.width; ++x) {
        image.at(c, x, y) = static_cast<float>(c * 10000 + y * 100 + x);
      }
    }
  }
  return image;
}

TEST(Image, EveryRowIsAlignedAndZero) {
  for (const int width : {1, 2, 15, 16, 17, 31, 32, 100}) {
    for (const int channels : {1, 2, 3, Image::max_channels}) {
      Image image({width, 5}, channels);
      EXPECT_EQ(image.row_stride() % 16, 0);
      EXPECT_GE(image.row_stride(), width);
      EXPECT_EQ(image.bytes(), static_cast<std::size_t>(image.row_stride()) * 5 * channels * sizeof(float));
      for (int c = 0; c < channels; ++c) {
        EXPECT_EQ(image.plane(c), image.row(c, 0).data());
        for (int y = 0; y < 5; ++y) {
          EXPECT_TRUE(aligned(image.row(c, y).data())) << width << " wide, channel " << c << ", row " << y;
          EXPECT_EQ(image.row(c, y).size(), static_cast<std::size_t>(width));
          EXPECT_THAT(image.row(c, y), testing::Each(0.0F));
        }
      }
    }
  }
}

TEST(Image, LargeImagesAreZeroAndAlignedToo) {
  const Image image({2000, 1000}, 3);  // beyond the size from which huge pages are asked for
  EXPECT_TRUE(aligned(image.plane(2)));
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < image.height(); ++y) {
      ASSERT_TRUE(std::ranges::all_of(image.row(c, y), [](float v) { return v == 0; })) << "row " << y;
    }
  }
}

TEST(Image, SamplesDoNotOverlap) {
  const Image image = numbered({17, 6}, 3);
  EXPECT_EQ(image.extent(), (Extent{17, 6}));
  EXPECT_EQ(image.extent().area(), 102);
  EXPECT_EQ(image.channels(), 3);
  EXPECT_FALSE(image.empty());
  EXPECT_EQ(image.at(0, 0, 0), 0.0F);
  EXPECT_EQ(image.at(1, 16, 5), 10516.0F);
  EXPECT_EQ(image.row(2, 4)[3], 20403.0F);
}

TEST(Image, DefaultIsEmpty) {
  const Image image;
  EXPECT_TRUE(image.empty());
  EXPECT_EQ(image.extent(), (Extent{0, 0}));
  EXPECT_EQ(image.channels(), 0);
  EXPECT_EQ(find_non_finite(image), std::nullopt);
  const Image copy = image;
  EXPECT_TRUE(copy.empty());
}

TEST(Image, CopiesAreDeepAndMovesLeaveNothing) {
  Image original = numbered({5, 4}, 1);
  Image copy = original;
  copy.at(0, 2, 2) = -1;
  EXPECT_EQ(original.at(0, 2, 2), 202.0F);
  original = copy;
  copy.at(0, 2, 2) = -2;
  EXPECT_EQ(original.at(0, 2, 2), -1.0F);

  const float* samples = original.plane(0);
  const Image moved = std::move(original);
  EXPECT_EQ(moved.plane(0), samples);
  EXPECT_TRUE(original.empty());  // NOLINT(bugprone-use-after-move,clang-analyzer-cplusplus.Move): promised
}

TEST(Image, ImpossibleSizesAreRefused) {
  constexpr int huge = std::numeric_limits<int>::max();
  EXPECT_THAT([] { Image({0, 7}, 1); }, ThrowsMessage<std::invalid_argument>(HasSubstr("image size 0x7")));
  EXPECT_THAT([] { Image({7, -3}, 1); }, ThrowsMessage<std::invalid_argument>(HasSubstr("7x-3: both sides")));
  EXPECT_THAT([] { Image({7, 7}, 0); }, ThrowsMessage<std::invalid_argument>(HasSubstr("0 channels: expected 1 to 8")));
  EXPECT_THAT([] { Image({7, 7}, 9); }, ThrowsMessage<std::invalid_argument>(HasSubstr("9 channels: expected 1 to 8")));
  EXPECT_THAT([] { Image({huge, huge}, 8); }, ThrowsMessage<std::invalid_argument>(HasSubstr("2147483647x2147483647")));
  // 2^62 samples of 4 bytes: the number of bytes would be 0 modulo 2^64.
  EXPECT_THAT([] { Image({1 << 30, 1 << 30}, 4); }, ThrowsMessage<std::invalid_argument>(HasSubstr("at most 2^40")));
}

TEST(Crop, CopiesTheWindow) {
  const Image source = numbered({20, 10}, 3);
  const Image window = crop(source, 4, 7, {16, 3});
  EXPECT_EQ(window.extent(), (Extent{16, 3}));
  EXPECT_EQ(window.channels(), 3);
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < 3; ++y) {
      for (int x = 0; x < 16; ++x) {
        EXPECT_EQ(window.at(c, x, y), source.at(c, x + 4, y + 7));
      }
    }
  }
  EXPECT_EQ(crop(source, 0, 0, source.extent()).at(2, 19, 9), 20919.0F);
}

TEST(Crop, WindowsOutsideAreRefused) {
  const Image source = numbered({20, 10}, 1);
  struct Case {
    int x, y;
    Extent extent;
  };
  for (const Case& bad : {Case{-1, 0, {5, 5}}, Case{0, -1, {5, 5}}, Case{16, 0, {5, 5}}, Case{0, 6, {5, 5}},
                          Case{25, 0, {1, 1}}, Case{0, 0, {21, 10}}, Case{std::numeric_limits<int>::max(), 0, {1, 1}},
                          Case{1, 1, {std::numeric_limits<int>::max(), 1}}}) {
    EXPECT_THAT([&] { crop(source, bad.x, bad.y, bad.extent); },
                ThrowsMessage<std::invalid_argument>(
                    AllOf(HasSubstr("is not inside an image of 20x10"), HasSubstr(std::to_string(bad.x)))));
  }
  EXPECT_THROW(crop(source, 3, 3, {0, 2}), std::invalid_argument);
  EXPECT_THROW(crop(Image(), 0, 0, {1, 1}), std::invalid_argument);
}

TEST(FindNonFinite, TellsTheFirstPlace) {
  Image image = numbered({33, 9}, 3);
  EXPECT_EQ(find_non_finite(image), std::nullopt);
  image.at(2, 1, 1) = std::numeric_limits<float>::quiet_NaN();
  image.at(1, 32, 8) = -std::numeric_limits<float>::infinity();
  const auto place = find_non_finite(image);
  ASSERT_TRUE(place.has_value());
  EXPECT_EQ(place->channel, 1);
  EXPECT_EQ(place->x, 32);
  EXPECT_EQ(place->y, 8);
}

}  // namespace textonbench::image_test
