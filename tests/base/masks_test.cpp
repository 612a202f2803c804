// Masks by name: how much is missing, and in which shapes.
#include "methods/base/masks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "methods/base/image_io.h"
#include "tests/temporary_folder.h"

namespace textonbench::masks_test {

using testing::AllOf;
using testing::HasSubstr;

const std::vector<std::string> shapes{"square", "holes", "ragged", "pixels", "lines"};

template <class... Parts>
auto refused(const Parts&... parts) {
  return testing::ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr(parts)...));
}

/// Connected parts of the mask, of neighbors across, down and diagonal.
std::vector<std::vector<Pixel>> parts_of(const Mask& mask) {
  std::vector<std::vector<Pixel>> parts;
  Mask seen(mask.extent());
  for (const Pixel& start : pixels_of(mask)) {
    if (seen.at(start.x, start.y)) continue;
    seen.set(start.x, start.y, true);
    std::vector<Pixel> part{start};
    for (std::size_t i = 0; i < part.size(); ++i) {
      const Pixel p = part[i];
      for (int y = std::max(0, p.y - 1); y <= std::min(mask.extent().height - 1, p.y + 1); ++y) {
        for (int x = std::max(0, p.x - 1); x <= std::min(mask.extent().width - 1, p.x + 1); ++x) {
          if (!mask.at(x, y) || seen.at(x, y)) continue;
          seen.set(x, y, true);
          part.push_back({x, y});
        }
      }
    }
    parts.push_back(part);
  }
  return parts;
}

TEST(MasksTest, RaggedPixelsAndLinesMissExactlyThePercentage) {
  for (const char* shape : {"ragged", "pixels", "lines"}) {
    for (const Extent extent : {Extent{3, 3}, Extent{40, 25}, Extent{131, 97}}) {
      for (const double percent : {0.001, 1.0, 5.0, 33.3, 50.0, 99.0, 99.999}) {
        const auto asked = std::llround(percent / 100 * static_cast<double>(extent.area()));
        const auto expected = std::clamp<std::int64_t>(asked, 1, extent.area() - 1);
        EXPECT_EQ(make_mask(shape, percent, extent).count(), expected)
            << shape << ' ' << extent.width << 'x' << extent.height << ' ' << percent;
      }
    }
  }
}

TEST(MasksTest, SquareIsOneInTheMiddle) {
  const Mask mask = make_mask("square", 25, {64, 36});
  const std::vector<Pixel> pixels = pixels_of(mask);
  EXPECT_EQ(bounding_box(pixels), (Rectangle{20, 6, {24, 24}}));
  EXPECT_EQ(mask.count(), 24 * 24);
  // A ring of one known pixel is left along the shorter side.
  EXPECT_EQ(bounding_box(pixels_of(make_mask("square", 99, {64, 36}))).size, (Extent{34, 34}));
  EXPECT_EQ(make_mask("square", 1, {3, 3}).count(), 1);
}

TEST(MasksTest, HolesAreSquaresThatLieApart) {
  struct Case {
    Extent extent;
    double percent;
    int side, apart;
  };
  for (const Case& c : {Case{{256, 200}, 5, 20, 8}, Case{{256, 256}, 20, 20, 8}, Case{{256, 256}, 45, 20, 1},
                        Case{{40, 60}, 10, 10, 8}, Case{{3, 5}, 10, 1, 1}}) {
    const Mask mask = make_mask("holes", c.percent, c.extent);
    const auto expected =
        std::max(1.0, std::round(c.percent / 100 * static_cast<double>(c.extent.area()) / (c.side * c.side)));
    std::vector<Rectangle> boxes;
    for (const std::vector<Pixel>& part : parts_of(mask)) {
      boxes.push_back(bounding_box(part));
      EXPECT_EQ(boxes.back().size, (Extent{c.side, c.side}));
      EXPECT_EQ(part.size(), static_cast<std::size_t>(c.side * c.side));
    }
    EXPECT_EQ(static_cast<double>(boxes.size()), expected) << c.percent;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const int between = std::max(std::abs(boxes[i].x - boxes[j].x), std::abs(boxes[i].y - boxes[j].y)) - c.side;
        EXPECT_GE(between, c.apart);
      }
    }
  }
}

TEST(MasksTest, HolesStopWhereNoMoreFindRoom) {
  const Mask mask = make_mask("holes", 95, {200, 200});
  EXPECT_GT(mask.count(), 0.45 * 200 * 200);
  EXPECT_LT(mask.count(), 0.75 * 200 * 200);
  for (const std::vector<Pixel>& part : parts_of(mask)) EXPECT_EQ(part.size(), 400U);
}

// A few large parts, where single pixels at random would make thousands.
TEST(MasksTest, RaggedIsOfLargeParts) {
  const auto parts = parts_of(make_mask("ragged", 10, {256, 256}));
  EXPECT_LT(parts.size(), 60U);
  std::size_t largest = 0;
  for (const auto& part : parts) largest = std::max(largest, part.size());
  EXPECT_GT(largest, 400U);
}

TEST(MasksTest, LinesAreTwoPixelsWide) {
  const Mask mask = make_mask("lines", 1, {200, 150});
  int lone = 0;
  for (const Pixel& p : pixels_of(mask)) {
    // Every pixel lies in a square of 2 x 2, and none deep inside: a square of 5 x 5 would need many scratches to
    // cross.
    int squares = 0;
    for (int y = p.y - 1; y <= p.y; ++y) {
      for (int x = p.x - 1; x <= p.x; ++x) {
        const bool inside = x >= 0 && y >= 0 && x + 1 < 200 && y + 1 < 150;
        squares += inside && mask.at(x, y) && mask.at(x + 1, y) && mask.at(x, y + 1) && mask.at(x + 1, y + 1) ? 1 : 0;
      }
    }
    const bool at_edge = p.x == 0 || p.y == 0 || p.x == 199 || p.y == 149;
    lone += squares == 0 && !at_edge ? 1 : 0;
  }
  // Every pixel lies in a square of 2 x 2, but for the last square, which the percentage cuts.
  EXPECT_LE(lone, 3);
  // None is deep inside: a square of 5 x 5 would need many scratches to cross.
  EXPECT_EQ(difference(mask, dilate(difference(Mask({200, 150}, true), mask), 2)).count(), 0);
}

TEST(MasksTest, PixelsAreSpreadEvenly) {
  const Mask mask = make_mask("pixels", 10, {200, 200});
  // Of each quarter about 1000 are missing, hypergeometric with deviation sqrt(4000 · 3/16 · 0.9) = 26: five of these
  // are left with probability 2e-6 in all.
  for (const Pixel& corner : {Pixel{0, 0}, Pixel{100, 0}, Pixel{0, 100}, Pixel{100, 100}}) {
    int missing = 0;
    for (const Pixel& p : pixels_of(mask)) {
      missing += p.x / 100 == corner.x / 100 && p.y / 100 == corner.y / 100 ? 1 : 0;
    }
    EXPECT_NEAR(missing, 1000, 130);
  }
}

TEST(MasksTest, ShapesAreTheSameEveryTime) {
  for (const std::string& shape : shapes) {
    EXPECT_EQ(make_mask(shape, 12, {50, 40}), make_mask(shape, 12, {50, 40})) << shape;
    EXPECT_THAT([&] { make_mask(shape, 10, {2, 9}); }, refused(shape, "2x9", "3x3"));
    for (const double percent : {0.0, 100.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
      EXPECT_THAT([&] { make_mask(shape, percent, {20, 20}); }, refused(shape, "percent", "less than 100"));
    }
  }
}

TEST(MasksTest, RectanglesAreTheirUnion) {
  const Mask mask = make_mask("rect:1,2,3,4;2,3,5,2;0,9,1,1", 10, {8, 10});
  for (int y = 0; y < 10; ++y) {
    for (int x = 0; x < 8; ++x) {
      const bool first = x >= 1 && x < 4 && y >= 2 && y < 6;
      const bool second = x >= 2 && x < 7 && y >= 3 && y < 5;
      EXPECT_EQ(mask.at(x, y), first || second || (x == 0 && y == 9)) << x << ' ' << y;
    }
  }
  for (const char* outside :
       {"rect:6,0,3,1", "rect:0,0,9,1", "rect:-1,0,2,2", "rect:0,0,2,2;0,9,1,2", "rect:1,1,2147483647,2147483647"}) {
    EXPECT_THAT([&] { make_mask(outside, 10, {8, 10}); }, refused("inside the picture of 8x10"));
  }
  for (const char* malformed : {"rect:", "rect:1,1,2,2;", "rect:1,1,2", "rect:1,1,0,2", "rect:1,1,2,2,3",
                                "rect:1;1;2;2", "rect:a,1,2,2", "rect:1, 1,2,2", "rect:1,1,2,99999999999"}) {
    EXPECT_THAT([&] { make_mask(malformed, 10, {8, 10}); }, refused("expected x,y,w,h"));
  }
}

TEST(MasksTest, ParsesARectangle) {
  EXPECT_EQ(parse_rectangle("78,79,100,101"), (Rectangle{78, 79, {100, 101}}));
  EXPECT_THAT([] { parse_rectangle("78,79,100"); }, refused("\"78,79,100\"", "x,y,w,h"));
}

TEST(MasksTest, NamesOfFilesAreThoseThatAreNoShape) {
  for (const std::string& shape : shapes) EXPECT_FALSE(mask_file(shape)) << shape;
  EXPECT_FALSE(mask_file("rect:1,2,3,4"));
  EXPECT_EQ(mask_file("holes.png"), std::filesystem::path("holes.png"));
  EXPECT_EQ(mask_file("./holes"), std::filesystem::path("./holes"));
}

class MaskPictureTest : public testing::Test {
 protected:
  std::string file(const std::string& name) const { return (folder_.path() / name).string(); }

 private:
  TemporaryFolder folder_;
};

TEST_F(MaskPictureTest, MissesWhereAnyChannelIsNotZero) {
  Image picture({6, 5}, 3);
  picture.at(0, 1, 1) = 1;
  picture.at(1, 2, 2) = 1.0F / 255;
  picture.at(2, 5, 4) = 0.5F;
  for (const char* name : {"mask.png", "mask.exr"}) {
    write_image(picture, file(name));
    EXPECT_THAT(pixels_of(make_mask(file(name), 10, {6, 5})),
                testing::ElementsAre(Pixel{1, 1}, Pixel{2, 2}, Pixel{5, 4}));
  }
}

TEST_F(MaskPictureTest, WhatIsNoNumberIsMissingAndMinusZeroIsNot) {
  Image picture({6, 5}, 1);
  picture.at(0, 1, 1) = std::numeric_limits<float>::quiet_NaN();
  picture.at(0, 2, 1) = std::numeric_limits<float>::infinity();
  picture.at(0, 3, 1) = -2;
  picture.at(0, 4, 1) = -0.0F;
  write_image(picture, file("mask.exr"));
  EXPECT_THAT(pixels_of(make_mask(file("mask.exr"), 10, {6, 5})),
              testing::ElementsAre(Pixel{1, 1}, Pixel{2, 1}, Pixel{3, 1}));
}

TEST_F(MaskPictureTest, TellsBothSizes) {
  write_image(Image({6, 5}, 1), file("mask.png"));
  EXPECT_THAT([&] { make_mask(file("mask.png"), 10, {5, 6}); }, refused("mask.png", "6x5", "5x6"));
}

TEST_F(MaskPictureTest, TellsWhatIsNoPicture) {
  std::ofstream(file("text.png")) << "not a picture";
  EXPECT_THAT([&] { make_mask(file("text.png"), 10, {5, 6}); }, refused("text.png", "expected PNG"));
  EXPECT_THAT([] { make_mask("hole", 10, {5, 6}); }, refused("\"hole\"", "no such file", "holes"));
  EXPECT_THAT([] { make_mask("", 10, {5, 6}); }, refused("\"\"", "no such file"));
}

}  // namespace textonbench::masks_test
