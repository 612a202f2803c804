// Reading pictures, good and bad. The files are written by OpenImageIO itself, or byte by byte where it cannot write
// them.
#include "methods/base/image_io.h"

#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/base/scratch_folder.h"

namespace textonbench::image_io_test {

using OIIO::ImageSpec;
using OIIO::TypeDesc;
using testing::AllOf;
using testing::HasSubstr;
using Sample = std::function<float(int c, int x, int y)>;

void write_picture(const std::filesystem::path& file, const ImageSpec& spec, const Sample& sample) {
  std::vector<float> samples;
  for (int y = 0; y < spec.height; ++y) {
    for (int x = 0; x < spec.width; ++x) {
      for (int c = 0; c < spec.nchannels; ++c) {
        samples.push_back(sample(c, x, y));
      }
    }
  }
  const auto output = OIIO::ImageOutput::create(file.string());
  ASSERT_TRUE(output && output->open(file.string(), spec)) << file;
  ASSERT_TRUE(output->write_image(TypeDesc::FLOAT, samples.data())) << output->geterror();
  ASSERT_TRUE(output->close()) << output->geterror();
}

void write_bytes(const std::filesystem::path& file, const std::vector<unsigned char>& bytes) {
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

template <class... Attribute>
ImageSpec spec_with(ImageSpec spec, const char* name, const Attribute&... value) {
  spec.attribute(name, value...);
  return spec;
}

void expect_samples(const std::filesystem::path& file, int channels, const Sample& expected, float tolerance = 0) {
  const ReadResult result = read_image(file);
  ASSERT_EQ(result.image.channels(), channels) << file;
  const ImageInfo info = read_image_info(file);
  EXPECT_EQ(info.extent, result.image.extent());
  EXPECT_EQ(info.channels, channels);
  for (int c = 0; c < channels; ++c) {
    for (int y = 0; y < result.image.height(); ++y) {
      for (int x = 0; x < result.image.width(); ++x) {
        ASSERT_NEAR(result.image.at(c, x, y), expected(c, x, y), tolerance)
            << file << ", x " << x << ", y " << y << ", channel " << c;
      }
    }
  }
}

void expect_refused(const std::filesystem::path& file, const std::string& reason) {
  const auto message =
      testing::ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr(file.string() + ": "), HasSubstr(reason)));
  EXPECT_THAT([&] { read_image(file); }, message);
}

/// Like expect_refused, and the header alone tells.
void expect_refused_at_once(const std::filesystem::path& file, const std::string& reason) {
  expect_refused(file, reason);
  EXPECT_THAT([&] { read_image_info(file); }, testing::ThrowsMessage<std::invalid_argument>(HasSubstr(reason)));
}

float eight_bits(int c, int x, int y) { return static_cast<float>((x + 40 * y + 100 * c) % 256) / 255.0F; }
float sixteen_bits(int c, int x, int y) {
  return static_cast<float>((997 * x + 4001 * y + 100 * c) % 65536) / 65535.0F;
}
/// Multiples of 1/8 in [−2, 10), which half precision holds too.
float beyond_one(int c, int x, int y) { return static_cast<float>((x + 5 * y + 31 * c) % 96) / 8.0F - 2.0F; }

TEST(ReadImage, EveryFormatDeliversItsSamplesExactly) {
  const ScratchFolder folder;
  struct Case {
    const char* name;
    TypeDesc type;
    Sample sample;
    const char* compression;
  };
  for (const Case& kind :
       {Case{"eight.png", TypeDesc::UINT8, eight_bits, ""}, Case{"sixteen.png", TypeDesc::UINT16, sixteen_bits, ""},
        Case{"eight.tif", TypeDesc::UINT8, eight_bits, "none"},
        Case{"sixteen.tif", TypeDesc::UINT16, sixteen_bits, "lzw"},
        Case{"float.tiff", TypeDesc::FLOAT, beyond_one, "zip"}, Case{"half.exr", TypeDesc::HALF, beyond_one, "piz"},
        Case{"float.exr", TypeDesc::FLOAT, beyond_one, "zip"}}) {
    for (const int channels : {1, 3}) {
      const auto file = folder / kind.name;
      write_picture(file, spec_with(ImageSpec(300, 7, channels, kind.type), "compression", kind.compression),
                    kind.sample);
      expect_samples(file, channels, kind.sample);
      EXPECT_THAT(read_image(file).notes, testing::IsEmpty());
    }
  }
}

TEST(ReadImage, TilesAndOnePixelAreRead) {
  const ScratchFolder folder;
  ImageSpec tiled(50, 40, 3, TypeDesc::UINT8);
  tiled.tile_width = tiled.tile_height = 16;
  write_picture(folder / "tiled.tif", tiled, eight_bits);
  expect_samples(folder / "tiled.tif", 3, eight_bits);
  write_picture(folder / "pixel.png", ImageSpec(1, 1, 3, TypeDesc::UINT8), eight_bits);
  expect_samples(folder / "pixel.png", 3, eight_bits);
}

TEST(ReadImage, JpegIsReadAsItIs) {
  const ScratchFolder folder;
  const auto smooth = [](int c, int x, int y) {
    return 0.5F + 0.1F * std::sin(static_cast<float>(3 * x + 2 * y + 30 * c) / 30);
  };
  const ImageSpec spec = spec_with(ImageSpec(64, 48, 3, TypeDesc::UINT8), "Compression", "jpeg:95");
  write_picture(folder / "smooth.jpg", spec, smooth);
  expect_samples(folder / "smooth.jpg", 3, smooth, 0.02F);
  write_picture(folder / "gray.jpg", ImageSpec(64, 48, 1, TypeDesc::UINT8), smooth);
  expect_samples(folder / "gray.jpg", 1, smooth, 0.02F);

  // A profile, a gamma or an orientation changes nothing.
  ImageSpec tagged = spec;
  const std::vector<unsigned char> profile(200, 7);
  tagged.attribute("ICCProfile", TypeDesc(TypeDesc::UINT8, 200), profile.data());
  tagged.attribute("Exif:ColorSpace", 65535);
  tagged.attribute("Orientation", 6);
  write_picture(folder / "tagged.jpg", tagged, smooth);
  const Image plain = read_image(folder / "smooth.jpg").image;
  expect_samples(folder / "tagged.jpg", 3, [&](int c, int x, int y) { return plain.at(c, x, y); });
  write_picture(folder / "linear.png", spec_with(ImageSpec(256, 2, 3, TypeDesc::UINT8), "oiio:ColorSpace", "Linear"),
                eight_bits);
  expect_samples(folder / "linear.png", 3, eight_bits);
}

TEST(ReadImage, PalettesAreExpanded) {
  const ScratchFolder folder;
  // 2x2 pixels of 8 bits: black, red; (10, 20, 30), white.
  write_bytes(folder / "palette.png",
              {0x89, 0x50, 0x4E, 0x47, 0x0D, 0x0A, 0x1A, 0x0A, 0x00, 0x00, 0x00, 0x0D, 0x49, 0x48, 0x44, 0x52,
               0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x02, 0x08, 0x03, 0x00, 0x00, 0x00, 0x45, 0x68, 0xFD,
               0x16, 0x00, 0x00, 0x00, 0x0C, 0x50, 0x4C, 0x54, 0x45, 0x00, 0x00, 0x00, 0xFF, 0x00, 0x00, 0x0A,
               0x14, 0x1E, 0xFF, 0xFF, 0xFF, 0xF8, 0x25, 0x2F, 0x47, 0x00, 0x00, 0x00, 0x0E, 0x49, 0x44, 0x41,
               0x54, 0x78, 0xDA, 0x63, 0x60, 0x60, 0x64, 0x60, 0x62, 0x06, 0x00, 0x00, 0x11, 0x00, 0x07, 0x83,
               0xCA, 0x64, 0x64, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4E, 0x44, 0xAE, 0x42, 0x60, 0x82});
  constexpr float levels[2][2][3] = {{{0, 0, 0}, {255, 0, 0}}, {{10, 20, 30}, {255, 255, 255}}};
  expect_samples(folder / "palette.png", 3, [&](int c, int x, int y) { return levels[y][x][c] / 255.0F; });
}

TEST(ReadImage, APaletteScanOfTheSystemIsRead) {
  const std::filesystem::path scan = "/usr/share/mypaint/backgrounds/mrmamurk/mamurk_f_1.png";
  if (!exists(scan)) {
    GTEST_SKIP() << "install the package mypaint-data-extras to read " << scan;
  }
  const Image image = read_image(scan).image;
  EXPECT_EQ(image.extent(), (Extent{960, 640}));
  EXPECT_EQ(image.channels(), 3);
  // Levels of 8 bits, whatever the palette.
  expect_samples(scan, 3, [&](int c, int x, int y) { return std::round(image.at(c, x, y) * 255.0F) / 255.0F; });
}

TEST(ReadImage, AConstantAlphaIsDroppedWithANote) {
  const ScratchFolder folder;
  for (const char* name : {"alpha.png", "alpha.tif"}) {
    for (const int channels : {1, 3}) {
      for (const float alpha : {1.0F, 0.4F, 0.0F}) {
        const auto file = folder / name;
        ImageSpec spec(40, 9, channels + 1, TypeDesc::UINT8);
        spec.alpha_channel = channels;
        // Colors are written as they are, not multiplied by alpha, and read so.
        spec.attribute("oiio:UnassociatedAlpha", 1);
        write_picture(file, spec, [&](int c, int x, int y) { return c == channels ? alpha : eight_bits(c, x, y); });
        expect_samples(file, channels, eight_bits);
        EXPECT_THAT(read_image(file).notes,
                    testing::ElementsAre(std::string(name) + ": dropped a constant alpha channel"));
      }
    }
  }
  write_picture(folder / "alpha.exr", ImageSpec(40, 9, 4, TypeDesc::FLOAT),
                [](int c, int x, int y) { return c == 3 ? 0.5F : beyond_one(c, x, y); });
  expect_samples(folder / "alpha.exr", 3, beyond_one);
  EXPECT_EQ(read_image(folder / "alpha.exr").notes.size(), 1U);
}

TEST(ReadImage, AVaryingAlphaIsDroppedWhenAskedFor) {
  const ScratchFolder folder;
  const auto file = folder / "alpha.png";
  ImageSpec spec(40, 9, 4, TypeDesc::UINT8);
  spec.alpha_channel = 3;
  spec.attribute("oiio:UnassociatedAlpha", 1);
  write_picture(file, spec, [](int c, int x, int y) { return c == 3 ? (x > y ? 1.0F : 0.0F) : eight_bits(c, x, y); });
  const ReadResult result = read_image(file, {.any_alpha = true});
  ASSERT_EQ(result.image.channels(), 3);
  for (int x = 0; x < 40; ++x) EXPECT_EQ(result.image.at(1, x, 5), eight_bits(1, x, 5)) << x;
  EXPECT_THAT(result.notes, testing::ElementsAre("alpha.png: dropped the alpha channel"));
}

TEST(ReadImage, SamplesThatAreNotFiniteAreReadWhenAskedFor) {
  const ScratchFolder folder;
  const auto file = folder / "holes.exr";
  const float nan = std::numeric_limits<float>::quiet_NaN();
  write_picture(file, ImageSpec(40, 9, 1, TypeDesc::FLOAT),
                [&](int c, int x, int y) { return x == 7 ? nan : beyond_one(c, x, y); });
  expect_refused(file, "not finite");
  const Image image = read_image(file, {.non_finite = true}).image;
  EXPECT_TRUE(std::isnan(image.at(0, 7, 3)));
  EXPECT_EQ(image.at(0, 8, 3), beyond_one(0, 8, 3));
}

TEST(ReadImage, AVaryingAlphaIsRefused) {
  const ScratchFolder folder;
  for (const int channels : {2, 4}) {
    write_picture(folder / "alpha.png", ImageSpec(40, 9, channels, TypeDesc::UINT8), [&](int c, int x, int y) {
      return c == channels - 1 ? (x == 7 && y == 5 ? 0.0F : 1.0F) : eight_bits(c, x, y);
    });
    expect_refused(folder / "alpha.png", "alpha channel that varies (1 at the first pixel, 0 at x 7, y 5)");
  }
}

TEST(ReadImage, WhatIsNoPictureIsRefused) {
  const ScratchFolder folder;
  expect_refused_at_once(folder / "missing.png", "no such file");
  expect_refused_at_once(folder.path(), "is a folder");
  write_bytes(folder / "empty.png", {});
  expect_refused_at_once(folder / "empty.png", "is empty");
  ASSERT_EQ(mkfifo((folder / "pipe.png").c_str(), 0600), 0);
  expect_refused_at_once(folder / "pipe.png", "is a device, pipe or socket");
  for (const char* name : {"text.png", "text.jpg", "text.tif", "text.exr", "text"}) {
    std::ofstream(folder / name) << "This is not a picture,\nwhatever its name says.\n";
    expect_refused_at_once(folder / name, "cannot be read as a picture");
  }
}

TEST(ReadImage, TruncatedFilesAreRefused) {
  const ScratchFolder folder;
  const Sample noise = [](int c, int x, int y) {
    return static_cast<float>((x * x * 31 + y * y * 17 + c * x * y) % 256) / 255;
  };
  struct Case {
    const char* name;
    TypeDesc type;
    const char *attribute, *value;
  };
  for (const Case& kind :
       {Case{"cut.png", TypeDesc::UINT8, "compression", "zip"},
        Case{"cut16.png", TypeDesc::UINT16, "compression", "zip"},
        Case{"cut.jpg", TypeDesc::UINT8, "Compression", "jpeg:90"},
        Case{"plain.tif", TypeDesc::UINT8, "compression", "none"},
        Case{"lzw.tif", TypeDesc::UINT16, "compression", "lzw"}, Case{"zip.tif", TypeDesc::FLOAT, "compression", "zip"},
        Case{"plain.exr", TypeDesc::FLOAT, "compression", "none"},
        Case{"zip.exr", TypeDesc::HALF, "compression", "zip"}}) {
    const auto whole = folder / (std::string("whole_") + kind.name);
    write_picture(whole, spec_with(ImageSpec(64, 48, 3, kind.type), kind.attribute, kind.value), noise);
    EXPECT_NO_THROW(read_image(whole));
    const auto size = static_cast<double>(file_size(whole));
    for (const double part : {0.02, 0.3, 0.6, 0.9, 0.99}) {
      copy_file(whole, folder / kind.name, std::filesystem::copy_options::overwrite_existing);
      resize_file(folder / kind.name, static_cast<std::uintmax_t>(part * size));
      SCOPED_TRACE(part);
      expect_refused(folder / kind.name, part < 0.1 ? "" : "truncated or damaged");
    }
  }
}

TEST(ReadImage, HugeDimensionsAreRefusedBeforeMemoryIsTaken) {
  const ScratchFolder folder;
  // A PNG header of 100000x100000 RGB pixels with a few bytes of data.
  write_bytes(folder / "huge.png",
              {0x89, 0x50, 0x4E, 0x47, 0x0D, 0x0A, 0x1A, 0x0A, 0x00, 0x00, 0x00, 0x0D, 0x49, 0x48, 0x44, 0x52, 0x00,
               0x01, 0x86, 0xA0, 0x00, 0x01, 0x86, 0xA0, 0x08, 0x02, 0x00, 0x00, 0x00, 0x27, 0x30, 0x9C, 0x9F, 0x00,
               0x00, 0x00, 0x0B, 0x49, 0x44, 0x41, 0x54, 0x78, 0xDA, 0x63, 0x60, 0x80, 0x01, 0x00, 0x00, 0x0A, 0x00,
               0x01, 0xEC, 0x24, 0x03, 0xB9, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4E, 0x44, 0xAE, 0x42, 0x60, 0x82});
  expect_refused_at_once(folder / "huge.png", "has 100000x100000 pixels of 3 channels; at most 2^28 samples are read");
}

TEST(ReadImage, NonFiniteSamplesAreRefusedWithTheirPlace) {
  const ScratchFolder folder;
  constexpr float infinity = std::numeric_limits<float>::infinity();
  for (const auto& [value, text] :
       {std::pair(std::nanf(""), "nan"), std::pair(infinity, "inf"), std::pair(-infinity, "-inf")}) {
    for (const TypeDesc type : {TypeDesc::HALF, TypeDesc::FLOAT}) {
      write_picture(folder / "bad.exr", ImageSpec(9, 6, 3, type),
                    [value = value](int c, int x, int y) { return c == 1 && x == 3 && y == 5 ? value : 0.5F; });
      expect_refused(folder / "bad.exr", std::string("sample ") + text + " at x 3, y 5, channel 1 is not finite");
    }
  }
}

/// A JPEG of one 8x8 block with four components and Adobe's marker: every coefficient is zero.
std::vector<unsigned char> cmyk_jpeg() {
  std::vector<unsigned char> bytes = {0xFF, 0xD8};
  const auto segment = [&](unsigned char marker, const std::vector<unsigned char>& data) {
    bytes.insert(bytes.end(), {0xFF, marker, 0, static_cast<unsigned char>(data.size() + 2)});
    bytes.insert(bytes.end(), data.begin(), data.end());
  };
  std::vector<unsigned char> quantization(65, 1);
  quantization[0] = 0;
  std::vector<unsigned char> huffman(18);  // one code of one bit, for the symbol 0
  huffman[1] = 1;
  segment(0xEE, {'A', 'd', 'o', 'b', 'e', 0, 100, 0, 0, 0, 0, 0});
  segment(0xDB, quantization);
  segment(0xC0, {8, 0, 8, 0, 8, 4, 1, 0x11, 0, 2, 0x11, 0, 3, 0x11, 0, 4, 0x11, 0});
  segment(0xC4, huffman);
  huffman[0] = 0x10;
  segment(0xC4, huffman);
  segment(0xDA, {4, 1, 0, 2, 0, 3, 0, 4, 0, 0, 63, 0});
  bytes.insert(bytes.end(), {0x00, 0xFF, 0xD9});
  return bytes;
}

TEST(ReadImage, OtherKindsOfChannelsAreRefused) {
  const ScratchFolder folder;
  write_bytes(folder / "cmyk.jpg", cmyk_jpeg());
  expect_refused_at_once(folder / "cmyk.jpg", "is a CMYK picture; convert it to RGB first");

  const auto named = [](std::vector<std::string> names, TypeDesc type) {
    ImageSpec spec(20, 10, static_cast<int>(names.size()), type);
    spec.channelnames = std::move(names);
    spec.alpha_channel = -1;
    return spec;
  };
  write_picture(folder / "cmyk.tif", spec_with(named({"C", "M", "Y", "K"}, TypeDesc::UINT8), "tiff:ColorSpace", "CMYK"),
                eight_bits);
  expect_refused_at_once(folder / "cmyk.tif", "is a CMYK picture; convert it to RGB first");
  write_picture(folder / "two.tif", named({"first", "second"}, TypeDesc::UINT8), eight_bits);
  expect_refused_at_once(folder / "two.tif", "has 2 channels");
  write_picture(folder / "motion.exr", named({"u", "v"}, TypeDesc::FLOAT), beyond_one);
  expect_refused_at_once(folder / "motion.exr", "has 2 channels (u, v); expected gray or RGB");
  write_picture(folder / "five.exr", named({"R", "G", "B", "u", "v"}, TypeDesc::FLOAT), beyond_one);
  expect_refused_at_once(folder / "five.exr", "has 5 channels");
}

TEST(ImageLibrary, TellsItsVersion) { EXPECT_THAT(image_library_version(), testing::StartsWith("2.")); }

}  // namespace textonbench::image_io_test
