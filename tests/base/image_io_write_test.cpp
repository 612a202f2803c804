// Writing pictures, and drawing on them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "methods/base/image_io.h"
#include "methods/base/random.h"
#include "tests/base/scratch_folder.h"

namespace textonbench::image_io_write_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// Normal noise of mean 1/2: about 5 % of the samples leave [0, 1].
Image noise(Extent extent, int channels) {
  Image image(extent, channels);
  for (int c = 0; c < channels; ++c) {
    for (int y = 0; y < extent.height; ++y) {
      fill_normal(Stream(Seed{3}).child(static_cast<std::uint64_t>(c)), static_cast<std::uint64_t>(y), 0,
                  image.row(c, y));
      for (float& v : image.row(c, y)) {
        v = 0.5F + 0.25F * v;
      }
    }
  }
  return image;
}

Image constant(Extent extent, int channels, float value) {
  Image image(extent, channels);
  for (int c = 0; c < channels; ++c) {
    for (int y = 0; y < extent.height; ++y) {
      std::ranges::fill(image.row(c, y), value);
    }
  }
  return image;
}

void expect_equal(const Image& found, const Image& expected, float tolerance) {
  ASSERT_EQ(found.extent(), expected.extent());
  ASSERT_EQ(found.channels(), expected.channels());
  for (int c = 0; c < expected.channels(); ++c) {
    for (int y = 0; y < expected.height(); ++y) {
      for (int x = 0; x < expected.width(); ++x) {
        ASSERT_NEAR(found.at(c, x, y), expected.at(c, x, y), tolerance)
            << "x " << x << ", y " << y << ", channel " << c;
      }
    }
  }
}

std::string contents(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<std::string> names_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  return names;
}

TEST(WriteImage, ExrKeepsEverySample) {
  const ScratchFolder folder;
  for (const int channels : {1, 3}) {
    const Image image = noise({70, 33}, channels);
    write_image(image, folder / "noise.exr");
    expect_equal(read_image(folder / "noise.exr").image, image, 0);
  }
}

TEST(WriteImage, PngRoundsToTheNearestLevelAndClamps) {
  const ScratchFolder folder;
  for (const int channels : {1, 3}) {
    Image image = noise({70, 33}, channels);
    write_image(image, folder / "noise.PNG");
    for (int c = 0; c < channels; ++c) {
      for (int y = 0; y < image.height(); ++y) {
        std::ranges::transform(image.row(c, y), image.row(c, y).begin(),
                               [](float v) { return std::clamp(v, 0.0F, 1.0F); });
      }
    }
    expect_equal(read_image(folder / "noise.PNG").image, image, 1.0F / 510 + 1e-6F);
  }
  EXPECT_THAT(names_in(folder.path()), testing::ElementsAre("noise.PNG"));
}

TEST(WriteImage, LevelsComeBackExactly) {
  const ScratchFolder folder;
  Image levels({256, 1}, 3);
  for (int x = 0; x < 256; ++x) {
    for (int c = 0; c < 3; ++c) {
      levels.at(c, x, 0) = static_cast<float>((x + 85 * c) % 256) / 255.0F;
    }
  }
  write_image(levels, folder / "levels.png");
  expect_equal(read_image(folder / "levels.png").image, levels, 0);
}

TEST(WriteImage, SamePictureGivesTheSameBytes) {
  const ScratchFolder folder;
  for (const std::string extension : {".png", ".exr"}) {
    write_image(noise({40, 30}, 3), folder / ("a" + extension));
    write_image(noise({40, 30}, 3), folder / ("b" + extension));
    EXPECT_EQ(contents(folder / ("a" + extension)), contents(folder / ("b" + extension)));
  }
}

TEST(WriteImage, OtherExtensionsAndChannelsAreRefused) {
  const ScratchFolder folder;
  for (const char* name : {"a.jpg", "a.tif", "a", "a.png.txt", "png"}) {
    EXPECT_THAT(
        [&] {
          write_image(noise({4, 4}, 3), folder / name);
        },
        ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr(name), HasSubstr("expected .png or .exr"))));
  }
  for (const int channels : {2, 4}) {
    EXPECT_THAT(
        [&] {
          write_image(noise({4, 4}, channels), folder / "a.png");
        },
        ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr("a.png"), HasSubstr("expected 1 or 3"))));
  }
  EXPECT_THROW(write_image(Image(), folder / "a.exr"), std::invalid_argument);
  EXPECT_THAT(names_in(folder.path()), testing::IsEmpty());
}

TEST(WriteImage, UnwritableTargetsAreErrors) {
  const ScratchFolder folder;
  std::ofstream(folder / "file") << "text";
  std::filesystem::create_directory(folder / "taken.png");
  for (const char* name : {"file/a.png", "missing/a.exr", "taken.png"}) {
    EXPECT_THAT(
        [&] {
          write_image(noise({4, 4}, 3), folder / name);
        },
        ThrowsMessage<std::runtime_error>(AllOf(HasSubstr(name), HasSubstr("cannot be written"))));
  }
  EXPECT_THAT(names_in(folder.path()), testing::UnorderedElementsAre("file", "taken.png"));
}

/// No file of this process grows beyond `bytes` while this lives: writing fails as on a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : previous_action_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &previous_);
    const rlimit limited{bytes, previous_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limited);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &previous_);
    std::signal(SIGXFSZ, previous_action_);
  }

 private:
  void (*previous_action_)(int);
  rlimit previous_{};
};

TEST(WriteImage, AFullDiskLeavesTheOldFileAlone) {
  const ScratchFolder folder;
  for (const std::string name : {"old.png", "old.exr"}) {
    for (const Extent extent : {Extent{4, 4}, Extent{300, 300}}) {  // fails at the last flush, or on the way
      std::ofstream(folder / name) << "old";
      std::string message;
      try {
        const FileSizeLimit limit(extent.width == 4 ? 16 : 4096);
        write_image(noise(extent, 3), folder / name);
      } catch (const std::runtime_error& error) {
        message = error.what();
      }
      EXPECT_THAT(message, AllOf(HasSubstr(name), HasSubstr("cannot be written")));
      EXPECT_EQ(contents(folder / name), "old");
    }
  }
  EXPECT_THAT(names_in(folder.path()), testing::UnorderedElementsAre("old.png", "old.exr"));
}

TEST(DrawText, ChangesNothingOutsideItsExtent) {
  for (const std::string text : {"RPN", "gjpq, |Ω| = 10²"}) {
    for (const int font_size : {10, 24}) {
      for (const int channels : {1, 3}) {
        const Extent covered = text_extent(text, font_size);
        const Image background = constant({400, 100}, channels, 0.25F);
        Image image = background;
        const int left = 40;
        const int baseline = 60;
        draw_text(image, left, baseline, text, font_size, 1.0F);
        float largest = 0;
        for (int c = 0; c < channels; ++c) {
          for (int y = 0; y < image.height(); ++y) {
            for (int x = 0; x < image.width(); ++x) {
              const bool inside =
                  x >= left - 1 && x <= left + covered.width + 1 && std::abs(y - baseline) <= covered.height;
              ASSERT_TRUE(inside || image.at(c, x, y) == 0.25F) << text << " at x " << x << ", y " << y;
              ASSERT_GE(image.at(c, x, y), 0.25F);
              ASSERT_EQ(image.at(c, x, y), image.at(0, x, y));
              largest = std::max(largest, image.at(c, x, y));
            }
          }
        }
        EXPECT_GT(largest, 0.9F) << "nothing was drawn";
      }
    }
  }
}

TEST(DrawText, IsCutAtTheBorder) {
  Image image({30, 20}, 3);
  EXPECT_NO_THROW(draw_text(image, -10, 15, "a long text that leaves the picture", 16, 1.0F));
  EXPECT_NO_THROW(draw_text(image, 5, 15, "", 16, 1.0F));
}

TEST(TextExtent, GrowsWithTextAndFont) {
  const Extent small = text_extent("ADSN", 12);
  const Extent large = text_extent("ADSN", 24);
  EXPECT_NEAR(large.width, 2 * small.width, 4);
  EXPECT_NEAR(large.height, 2 * small.height, 3);
  EXPECT_GT(text_extent("ADSN ADSN", 12).width, 2 * small.width);
}

TEST(Resize, EnlargesWithoutNewValues) {
  const Image image = noise({5, 4}, 3);
  const Image large = resize(image, {15, 8});
  ASSERT_EQ(large.extent(), (Extent{15, 8}));
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < 8; ++y) {
      for (int x = 0; x < 15; ++x) {
        EXPECT_EQ(large.at(c, x, y), image.at(c, x / 3, y / 2));
      }
    }
  }
  expect_equal(resize(image, image.extent()), image, 0);
}

TEST(Resize, KeepsConstantsAndMeans) {
  for (const Extent size : {Extent{20, 15}, Extent{7, 50}, Extent{100, 3}, Extent{1, 1}, Extent{90, 80}}) {
    expect_equal(resize(constant({64, 48}, 3, 0.3F), size), constant(size, 3, 0.3F), 5e-6F);
  }
  // A ramp keeps its values at the pixels' centers, far from the border.
  Image ramp({64, 48}, 1);
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) {
      ramp.at(0, x, y) = static_cast<float>(x) / 64;
    }
  }
  const Image half = resize(ramp, {32, 24});
  for (int x = 8; x < 24; ++x) {
    EXPECT_NEAR(half.at(0, x, 12), (2 * x + 0.5) / 64, 1e-3);
  }
}

TEST(Resize, ImpossibleSizesAreRefused) { EXPECT_THROW(resize(noise({8, 8}, 1), {0, 4}), std::invalid_argument); }

}  // namespace textonbench::image_io_write_test
