#include "methods/base/image_maps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "methods/base/image_io.h"
#include "methods/base/image_io_tiled.h"
#include "tests/temporary_folder.h"
#include "tests/texture.h"

namespace textonbench::image_maps_test {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

const std::vector<ImageMap> material{{"albedo", 3}, {"height", 1}, {"normal.gl", 3}};

bool same(const Image& a, const Image& b) {
  if (a.extent() != b.extent() || a.channels() != b.channels()) return false;
  for (int i = 0; i < a.channels() * a.height(); ++i) {
    if (!std::ranges::equal(a.row(i / a.height(), i % a.height()), b.row(i / a.height(), i % a.height()))) return false;
  }
  return true;
}

TEST(ImageMaps, ChannelsAreNamedByTheirMapAndTellIt) {
  const std::vector<std::string> names = channel_names(material);
  EXPECT_THAT(names,
              ElementsAre("albedo.R", "albedo.G", "albedo.B", "height.Y", "normal.gl.R", "normal.gl.G", "normal.gl.B"));
  EXPECT_EQ(maps_of_channels(names), material);
  EXPECT_THAT(channel_names({}), IsEmpty());
}

TEST(ImageMaps, OtherChannelsAreNoStack) {
  for (const std::vector<std::string>& names : {std::vector<std::string>{"R", "G", "B"},
                                                {"a.R", "a.G", "a.B"},
                                                {"a.R", "a.G", "b.Y"},
                                                {"a.Y", "Z"},
                                                {".Y", "b.Y"},
                                                {}}) {
    EXPECT_THAT(maps_of_channels(names), IsEmpty());
  }
}

TEST(ImageMaps, AStackSplitsIntoWhatItWasMadeOf) {
  const std::vector<Image> pictures{test_texture({9, 7}, 3, 1), test_texture({9, 7}, 1, 2), test_texture({9, 7}, 3, 3)};
  const Image stack = stack_images(pictures);
  ASSERT_EQ(stack.channels(), 7);
  const std::vector<Image> parts = split_maps(stack, material);
  ASSERT_EQ(parts.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(same(parts[i], pictures[i])) << i;
}

TEST(ImageMaps, UnusableStacksAreRefused) {
  const Image color = test_texture({9, 7}, 3);
  EXPECT_THAT(
      [&] {
        stack_images(std::vector{color, color, color});
      },
      ThrowsMessage<std::invalid_argument>("a stack of 9 channels: expected at most 8"));
  EXPECT_THAT(
      [&] {
        stack_images(std::vector{color, test_texture({7, 9}, 1)});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("9x7 and 7x9 pixels")));
  EXPECT_THROW(stack_images({}), std::invalid_argument);
  EXPECT_THAT([&] { split_maps(color, material); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("maps of 7 channels in all and an image of 3")));
}

TEST(ImageMaps, SideBySideIsEveryMapInColorWithAGapOfWhite) {
  const std::vector<Image> pictures{test_texture({9, 7}, 3, 1), test_texture({9, 7}, 1, 2)};
  const Image sheet = side_by_side(stack_images(pictures), std::vector<ImageMap>{{"a", 3}, {"b", 1}});
  ASSERT_EQ(sheet.extent(), (Extent{20, 7}));
  ASSERT_EQ(sheet.channels(), 3);
  EXPECT_TRUE(same(crop(sheet, 0, 0, {9, 7}), pictures[0]));
  for (int c = 0; c < 3; ++c) {
    EXPECT_EQ(sheet.at(c, 9, 3), 1.0F);
    EXPECT_EQ(sheet.at(c, 10, 6), 1.0F);
    EXPECT_EQ(sheet.at(c, 11 + 4, 5), pictures[1].at(0, 4, 5));
  }
}

TEST(ImageMaps, AnExrFileKeepsNamesAndValues) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "stack.exr";
  const Image stack = test_texture({300, 270}, 7);
  const auto expect_read_back = [&] {
    const ReadResult read = read_image(file);
    EXPECT_EQ(read.maps, material);  // in alphabetical order, as OpenEXR sorts them
    EXPECT_TRUE(same(read.image, stack));
    EXPECT_EQ(read_image_info(file).channels, 7);
  };
  write_image(stack, file, material);
  expect_read_back();

  TiledImageWriter writer(file, stack.extent(), 7, material);
  for (int band = 0; band < writer.bands(); ++band) {
    writer.write_band(crop(stack, 0, band * TiledImageWriter::tile, {300, writer.band_height(band)}));
  }
  writer.finish();
  expect_read_back();
}

TEST(ImageMaps, OnlyExrHoldsMapsAndAsManyChannels) {
  const TemporaryFolder folder;
  const Image stack = test_texture({8, 8}, 7);
  EXPECT_THROW(write_image(stack, folder.path() / "stack.png", material), std::invalid_argument);
  EXPECT_THROW(write_image(stack, folder.path() / "stack.exr"), std::invalid_argument);
  EXPECT_THAT(
      [&] {
        write_image(test_texture({8, 8}, 3), folder.path() / "stack.exr", material);
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("3 channels as maps of 7")));
  EXPECT_THROW(TiledImageWriter(folder.path() / "stack.exr", {8, 8}, 4, material), std::invalid_argument);
  EXPECT_THROW(TiledImageWriter(folder.path() / "stack.exr", {8, 8}, 4), std::invalid_argument);
}

}  // namespace textonbench::image_maps_test
