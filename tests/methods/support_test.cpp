#include "methods/spot/support.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "methods/base/image_io.h"
#include "tests/temporary_folder.h"
#include "tests/texture.h"

namespace textonbench::support_test {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr Extent exemplar{40, 30};

Support from(const std::map<std::string, ParamValue>& given, int default_support = 31) {
  return support_of(Params(support_params(default_support), given), exemplar);
}

TEST(Support, SquareAndDiscHoldTheirPixels) {
  const Support square = square_support(7);
  EXPECT_EQ(square.box, (Extent{7, 7}));
  EXPECT_EQ(square.pixels, 49);
  // Gauss's circle problem: 5, 13, 29, 81, 709 and 1961 points of Z² in discs of radius 1, 2, 3, 5, 15 and 25.
  for (const auto& [radius, pixels] : {std::pair{0, 1}, {1, 5}, {2, 13}, {3, 29}, {5, 81}, {15, 709}, {25, 1961}}) {
    const Support disc = disc_support(radius);
    EXPECT_EQ(disc.box, (Extent{2 * radius + 1, 2 * radius + 1}));
    EXPECT_EQ(disc.pixels, pixels);
    EXPECT_EQ(std::ranges::count(disc.inside, 1), pixels);
  }
}

TEST(Support, MaskIsCroppedToItsBoundingBox) {
  Image mask({9, 8}, 3);
  mask.at(0, 2, 3) = 1;
  mask.at(2, 5, 6) = -0.5F;
  const Support support = mask_support(mask);
  EXPECT_EQ(support.box, (Extent{4, 4}));
  EXPECT_EQ(support.pixels, 2);
  EXPECT_EQ(support.inside.front(), 1);
  EXPECT_EQ(support.inside.back(), 1);
  EXPECT_THAT(
      [] {
        mask_support(Image({4, 5}, 1));
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("4x5 pixels is zero everywhere")));
}

TEST(Support, RunsCoverTheSupportOnce) {
  Image mask({12, 3}, 1);
  for (const int x : {0, 1, 4, 9, 10, 11}) mask.at(0, x, 0) = 1;
  mask.at(0, 5, 2) = 1;
  const std::vector<SupportRun> runs = support_runs(mask_support(mask));
  ASSERT_EQ(runs.size(), 4U);
  EXPECT_EQ(runs[0].last - runs[0].first, 2);
  EXPECT_EQ(runs[1].first, 4);
  EXPECT_EQ(runs[2].last, 12);
  EXPECT_EQ(runs[3].y, 2);
  std::int64_t pixels = 0;
  for (const SupportRun& run : support_runs(disc_support(9))) pixels += run.last - run.first;
  EXPECT_EQ(pixels, disc_support(9).pixels);
}

TEST(Support, CropWrapsAroundTheTorusAndIsZeroOutside) {
  const Image torus = test_texture({10, 8}, 3);
  const Support disc = disc_support(2);
  const Image cropped = crop_to_support(torus, -2, 6, disc);
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < 5; ++y) {
      for (int x = 0; x < 5; ++x) {
        const bool inside = (x - 2) * (x - 2) + (y - 2) * (y - 2) <= 4;
        EXPECT_EQ(cropped.at(c, x, y), inside ? torus.at(c, (x + 8) % 10, (y + 6) % 8) : 0.0F) << x << " " << y;
      }
    }
  }
}

TEST(SupportParams, DescribeTheSupport) {
  EXPECT_EQ(from({{"support", std::int64_t{5}}}).pixels, 25);
  EXPECT_EQ(from({{"support", std::int64_t{5}}, {"shape", std::string("disc")}}).pixels, 81);
  EXPECT_EQ(from({}, 0).box, exemplar);
  EXPECT_EQ(from({}, 0).pixels, exemplar.area());
  EXPECT_EQ(from({{"shape", std::string("disc")}}, 0).box, exemplar) << "0 is the whole exemplar, whatever the shape";
}

TEST(SupportParams, MaskComesFromAFile) {
  const TemporaryFolder folder;
  Image mask({6, 4}, 1);
  mask.at(0, 1, 1) = 1;
  mask.at(0, 3, 2) = 1;
  const std::string file = (folder.path() / "mask.png").string();
  write_image(mask, file);
  EXPECT_EQ(from({{"shape", std::string("mask")}, {"mask", file}}).box, (Extent{3, 2}));
  write_image(Image({6, 4}, 1), file);
  EXPECT_THAT(
      [&] {
        from({{"shape", std::string("mask")}, {"mask", file}});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("zero everywhere")));
  std::ofstream(file) << "not a picture";
  EXPECT_THAT(
      [&] {
        from({{"shape", std::string("mask")}, {"mask", file}});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("mask.png")));
  mask = Image({41, 4}, 1);
  mask.at(0, 0, 0) = mask.at(0, 40, 0) = 1;
  write_image(mask, file);
  EXPECT_THAT(
      [&] {
        from({{"shape", std::string("mask")}, {"mask", file}});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("41x1 pixels")));
}

TEST(SupportParams, RefuseWhatDoesNotFit) {
  for (const auto& [size, shape] : {std::pair{31, "square"}, {15, "disc"}, {2'000'000'000, "square"}}) {
    EXPECT_THAT(([size = size, shape = shape] {
                  from({{"support", std::int64_t{size}}, {"shape", std::string(shape)}});
                }),
                ThrowsMessage<std::invalid_argument>(HasSubstr("no more than the exemplar's 40x30")));
  }
  EXPECT_THROW(from({{"support", std::int64_t{-1}}}), std::invalid_argument);
  EXPECT_THAT(
      [] {
        from({{"shape", std::string("mask")}});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("needs the option mask")));
  EXPECT_THAT(
      [] {
        from({{"mask", std::string("mask.png")}});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("expected shape \"mask\"")));
}

}  // namespace textonbench::support_test
