#include "methods/base/image_io_tiled.h"

#include <gmock/gmock.h>
#include <sys/resource.h>

#include <csignal>
#include <stdexcept>

#include "methods/base/image_io.h"
#include "tests/base/scratch_folder.h"

namespace textonbench::image_io_tiled_test {

float value_at(int c, int x, int y) { return static_cast<float>(c + 10 * x + 10000 * y) / 7.0F; }

Image band_of(const TiledImageWriter& writer, int band, int width, int channels) {
  Image image({width, writer.band_height(band)}, channels);
  for (int c = 0; c < channels; ++c) {
    for (int y = 0; y < image.height(); ++y) {
      for (int x = 0; x < width; ++x) {
        image.at(c, x, y) = value_at(c, x, band * TiledImageWriter::tile + y);
      }
    }
  }
  return image;
}

TEST(TiledImageWriterTest, EveryPixelComesBack) {
  const ScratchFolder folder;
  for (const int channels : {1, 3}) {
    const Extent extent{300, 520};  // neither side a multiple of the tile's
    const std::filesystem::path file = folder.path() / "tiles.exr";
    TiledImageWriter writer(file, extent, channels);
    ASSERT_EQ(writer.bands(), 3);
    EXPECT_EQ(writer.band_height(2), 8);
    for (int band = 0; band < writer.bands(); ++band) {
      writer.write_band(band_of(writer, band, extent.width, channels));
    }
    EXPECT_FALSE(channels == 1 && std::filesystem::exists(file));
    writer.finish();

    const Image image = read_image(file).image;
    ASSERT_EQ(image.extent(), extent);
    ASSERT_EQ(image.channels(), channels);
    for (int c = 0; c < channels; ++c) {
      for (int y = 0; y < extent.height; ++y) {
        for (int x = 0; x < extent.width; ++x) {
          ASSERT_EQ(image.at(c, x, y), value_at(c, x, y)) << c << ' ' << x << ' ' << y;
        }
      }
    }
  }
}

TEST(TiledImageWriterTest, AnUnfinishedPictureLeavesNothingBehind) {
  const ScratchFolder folder;
  {
    TiledImageWriter writer(folder.path() / "tiles.exr", {300, 520}, 1);
    writer.write_band(band_of(writer, 0, 300, 1));
    EXPECT_THROW(writer.finish(), std::invalid_argument);
    EXPECT_THROW(writer.write_band(Image({300, 8}, 1)), std::invalid_argument);
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(TiledImageWriterTest, OtherFilesAreRefused) {
  EXPECT_THROW(TiledImageWriter("picture.png", {300, 520}, 3), std::invalid_argument);
  EXPECT_THROW(TiledImageWriter("picture.exr", {300, 520}, 2), std::invalid_argument);
  EXPECT_THROW(TiledImageWriter("/nowhere/at/all/picture.exr", {300, 520}, 3), std::runtime_error);
}

// A file that may not grow past a megabyte stands for a full disk.
TEST(TiledImageWriterTest, AFullDiskIsToldAndTheFileGoes) {
  const ScratchFolder folder;
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit limit = before;
  limit.rlim_cur = 1 << 20;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
  const auto write = [&] {
    TiledImageWriter writer(folder.path() / "tiles.exr", {1024, 1024}, 1);
    for (int band = 0; band < writer.bands(); ++band) {
      writer.write_band(band_of(writer, band, 1024, 1));
    }
    writer.finish();
  };
  EXPECT_THROW(write(), std::runtime_error);
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace textonbench::image_io_tiled_test
