// Pictures of components, and the line that tells how far a solution is.
#include "experiments/inpainting_pictures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <stdexcept>
#include <thread>

#include "experiments/progress.h"

namespace textonbench::inpainting_pictures_test {

Image filled(Extent extent, int channels, float value) {
  Image image(extent, channels);
  for (int c = 0; c < channels; ++c) {
    for (int y = 0; y < extent.height; ++y) {
      for (float& v : image.row(c, y)) v = value;
    }
  }
  return image;
}

TEST(InpaintingPictures, WhatIsNotShownIsFarFromTheRest) {
  Mask shown({6, 4});
  shown.set(2, 1, true);
  shown.set(3, 1, true);
  for (const float value : {0.2F, 0.7F}) {
    Image picture = filled({6, 4}, 3, std::numeric_limits<float>::quiet_NaN());
    for (int c = 0; c < 3; ++c) {
      picture.at(c, 2, 1) = value;
      picture.at(c, 3, 1) = value;
    }
    const Image result = only_pixels(picture, shown);
    EXPECT_EQ(result.at(1, 3, 1), value);
    EXPECT_EQ(result.at(1, 4, 1), value < 0.5F ? 1.0F : 0.0F);
  }
}

TEST(InpaintingPictures, AStripHoldsThePicturesSideBySide) {
  const Image strip = picture_strip(
      std::vector<CaptionedPicture>{{"a", filled({80, 40}, 1, 0.25F)}, {"b", filled({80, 40}, 1, 0.75F)}});
  // Enlarged twice, to 160 x 80; 8 pixels between them and a line for the captions.
  EXPECT_EQ(strip.width(), 2 * 160 + 3 * 8);
  EXPECT_EQ(strip.height(), 24 + 80 + 8);
  EXPECT_EQ(strip.channels(), 1);
  for (const int x : {8, 167}) EXPECT_EQ(strip.at(0, x, 24), 0.25F) << x;
  for (const int x : {176, 335}) EXPECT_EQ(strip.at(0, x, 103), 0.75F) << x;
  EXPECT_EQ(strip.at(0, 171, 60), 1.0F);
  float darkest = 1;
  for (int y = 0; y < 22; ++y) {
    for (const float v : strip.row(0, y)) darkest = std::min(darkest, v);
  }
  EXPECT_LT(darkest, 0.3F) << "a caption is drawn";
}

TEST(InpaintingPictures, AStripOfLargePicturesIsReduced) {
  const Image strip = picture_strip(std::vector<CaptionedPicture>{{"large", filled({2048, 700}, 3, 0.5F)}});
  EXPECT_EQ(strip.extent(), (Extent{512 + 16, 175 + 32}));
  EXPECT_NEAR(strip.at(2, 200, 100), 0.5F, 1e-5);
}

TEST(InpaintingPictures, AStripRefusesPicturesThatDiffer) {
  const CaptionedPicture gray{"a", Image({5, 5}, 1)};
  for (const Image& other : {Image({5, 6}, 1), Image({5, 5}, 3)}) {
    EXPECT_THROW(picture_strip(std::vector<CaptionedPicture>{gray, {"b", other}}), std::invalid_argument);
  }
  EXPECT_THROW(picture_strip(std::vector<CaptionedPicture>{{"a", Image({5, 5}, 2)}}), std::invalid_argument);
  EXPECT_THROW(picture_strip({}), std::invalid_argument);
}

TEST(StatusLineTest, IsSilentForTwoSecondsAndThenTells) {
  testing::internal::CaptureStderr();
  {
    StatusLine line(true);
    StatusLine quiet(false);
    EXPECT_FALSE(line.due());
    line.tell("too early");
    std::this_thread::sleep_for(std::chrono::milliseconds(2050));
    EXPECT_TRUE(line.due());
    EXPECT_FALSE(quiet.due());
    line.tell("iteration 7");
    quiet.tell("nothing");
    line.tell("too soon after");
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "iteration 7\n");
}

}  // namespace textonbench::inpainting_pictures_test
