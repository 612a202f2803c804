#include "methods/base/image_io.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace textonbench {
namespace {

constexpr std::int64_t most_samples = std::int64_t{1} << 28;
constexpr const char* font = "DejaVuSans";

[[noreturn]] void reject(const std::filesystem::path& file, const std::string& what) {
  throw std::invalid_argument(fmt::format("{}: {}", file.string(), what));
}

std::string extension_of(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
  return extension;
}

/// OpenImageIO puts every complaint of a decoder on a line of its own.
std::string one_line(std::string message) {
  std::ranges::replace(message, '\n', ' ');
  return message;
}

std::unique_ptr<OIIO::ImageInput> open(const std::filesystem::path& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) {
    reject(file, "no such file; expected a PNG, JPEG, TIFF or EXR picture");
  }
  if (std::filesystem::is_directory(status)) {
    reject(file, "is a folder; expected a PNG, JPEG, TIFF or EXR picture");
  }
  if (!std::filesystem::is_regular_file(status)) {
    reject(file, "is a device, pipe or socket; expected a PNG, JPEG, TIFF or EXR picture");
  }
  if (std::filesystem::file_size(file, error) == 0 && !error) {
    reject(file, "is empty; expected a PNG, JPEG, TIFF or EXR picture");
  }
  // Colors as stored, not multiplied by alpha: a constant alpha is dropped, and must not darken the picture before.
  OIIO::ImageSpec as_stored;
  as_stored.attribute("oiio:UnassociatedAlpha", 1);
  auto input = OIIO::ImageInput::open(file.string(), &as_stored);
  if (!input) {
    reject(file, fmt::format("cannot be read as a picture ({}); expected PNG, JPEG, TIFF or EXR",
                             one_line(OIIO::geterror())));
  }
  if (input->has_error()) {
    reject(file, fmt::format("is truncated or damaged ({})", one_line(input->geterror())));
  }
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.width < 1 || spec.height < 1 || spec.depth > 1) {
    reject(file, fmt::format("has size {}x{}x{}; expected one plane of pixels", spec.width, spec.height, spec.depth));
  }
  if (std::int64_t{spec.width} * spec.height * spec.nchannels > most_samples) {
    reject(file, fmt::format("has {}x{} pixels of {} channels; at most 2^28 samples are read", spec.width, spec.height,
                             spec.nchannels));
  }
  return input;
}

/// Color channels of a file, apart from an alpha channel at `alpha` (−1 when there is none), or those of its maps.
struct Channels {
  int color = 0;
  int alpha = -1;
  std::vector<ImageMap> maps = {};
};

Channels classify(const std::filesystem::path& file, const OIIO::ImageSpec& spec) {
  const std::string color_space = spec.get_string_attribute("tiff:ColorSpace");
  if (color_space == "CMYK" || spec.get_string_attribute("jpeg:ColorSpace") == "CMYK" ||
      std::ranges::find(spec.channelnames, "K") != spec.channelnames.end()) {
    reject(file, "is a CMYK picture; convert it to RGB first");
  }
  if (std::vector<ImageMap> maps = maps_of_channels(spec.channelnames); !maps.empty()) {
    if (spec.nchannels > Image::max_channels) {
      reject(file, fmt::format("has {} channels in {} maps; expected at most {}", spec.nchannels, maps.size(),
                               Image::max_channels));
    }
    return {spec.nchannels, -1, std::move(maps)};
  }
  const int alpha = spec.alpha_channel;
  const int color = spec.nchannels - (alpha >= 0 ? 1 : 0);
  if (color != 1 && color != 3) {
    reject(file, fmt::format("has {} channels ({}); expected gray or RGB, with or without alpha, or maps of those",
                             spec.nchannels, fmt::join(spec.channelnames, ", ")));
  }
  return {color, alpha, {}};
}

/// Highest level v of 8 and 16 bit samples, 0 for others. OpenImageIO multiplies levels by 1/v in float32, which misses
/// the nearest float to level / v for some of them.
float highest_level(const OIIO::TypeDesc& format) {
  return format == OIIO::TypeDesc::UINT8 ? 255.0F : format == OIIO::TypeDesc::UINT16 ? 65535.0F : 0.0F;
}

}  // namespace

ImageInfo read_image_info(const std::filesystem::path& file) {
  const auto input = open(file);
  const OIIO::ImageSpec& spec = input->spec();
  return {{spec.width, spec.height}, classify(file, spec).color};
}

ReadResult read_image(const std::filesystem::path& file, const ReadOptions& options) {
  const auto input = open(file);
  const OIIO::ImageSpec& spec = input->spec();
  const auto [color, alpha, maps] = classify(file, spec);
  const auto width = static_cast<std::size_t>(spec.width);
  const auto height = static_cast<std::size_t>(spec.height);
  const auto channels = static_cast<std::size_t>(spec.nchannels);
  std::vector<float> samples(width * height * channels);
  // Decoders fill what they miss of a JPEG or TIFF with gray or black, report success, and leave a message.
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, samples.data()) || input->has_error()) {
    reject(file, fmt::format("is truncated or damaged ({})", one_line(input->geterror())));
  }
  const float levels = highest_level(spec.format);
  ReadResult result{Image({spec.width, spec.height}, color), {}, maps};
  int target = 0;
  for (std::size_t c = 0; c < channels; ++c) {
    if (static_cast<int>(c) == alpha) {
      for (std::size_t i = c; i < samples.size() && !options.any_alpha; i += channels) {
        if (samples[i] != samples[c]) {
          reject(file, fmt::format("has an alpha channel that varies ({} at the first pixel, {} at x {}, y {}); "
                                   "flatten it first",
                                   samples[c], samples[i], i / channels % width, i / channels / width));
        }
      }
      result.notes.push_back(fmt::format("{}: dropped {} alpha channel", file.filename().string(),
                                         options.any_alpha ? "the" : "a constant"));
      continue;
    }
    for (std::size_t y = 0; y < height; ++y) {
      const auto row = result.image.row(target, static_cast<int>(y));
      for (std::size_t x = 0; x < width; ++x) {
        const float sample = samples[(y * width + x) * channels + c];
        row[x] = levels > 0 ? std::round(sample * levels) / levels : sample;
      }
    }
    ++target;
  }
  if (options.non_finite) return result;
  if (const auto bad = find_non_finite(result.image)) {
    reject(file, fmt::format("sample {} at x {}, y {}, channel {} is not finite",
                             result.image.at(bad->channel, bad->x, bad->y), bad->x, bad->y, bad->channel));
  }
  return result;
}

namespace {

OIIO::ImageBuf to_buffer(const Image& image) {
  OIIO::ImageBuf buffer(OIIO::ImageSpec(image.width(), image.height(), image.channels(), OIIO::TypeDesc::FLOAT));
  auto* samples = static_cast<float*>(buffer.localpixels());
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      for (int c = 0; c < image.channels(); ++c) {
        *samples++ = image.at(c, x, y);
      }
    }
  }
  return buffer;
}

/// The bytes of a PNG or EXR file.
std::vector<unsigned char> encode(const Image& image, const std::string& extension, std::span<const ImageMap> maps,
                                  const OIIO::TypeDesc& of_png = OIIO::TypeDesc::UINT8) {
  OIIO::ImageBuf buffer = to_buffer(image);
  if (!maps.empty()) {
    buffer.specmod().channelnames = channel_names(maps);
  }
  OIIO::TypeDesc type = OIIO::TypeDesc::FLOAT;
  if (extension == ".png") {
    type = of_png;
    // Values are sample values of the exemplar's own encoding; saying so keeps OpenImageIO from converting them.
    buffer.specmod().attribute("oiio:ColorSpace", "sRGB");
    buffer.specmod().attribute("png:compressionLevel", 6);
  }
  // OpenImageIO would note the time of writing in an EXR file, and the same picture would not have the same bytes.
  buffer.specmod().attribute("DateTime", "2000:01:01 00:00:00");
  OIIO::Filesystem::IOVecOutput memory;
  buffer.set_write_ioproxy(&memory);
  if (!buffer.write("picture" + extension, type)) {
    throw std::runtime_error(fmt::format("a picture of {}x{} cannot be encoded as {} ({})", image.width(),
                                         image.height(), extension, one_line(buffer.geterror())));
  }
  return std::move(memory.buffer());
}

/// Encoded in memory, because OpenImageIO does not tell when the disk is full; written beside under a name of this
/// process, so that a reader never sees half a picture.
void write_bytes(const std::vector<unsigned char>& bytes, const std::filesystem::path& file) {
  const std::filesystem::path beside =
      file.parent_path() / fmt::format(".{}.{}{}", file.stem().string(), getpid(), file.extension().string());
  std::ofstream stream(beside, std::ios::binary);
  stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  stream.close();
  std::error_code error;
  if (stream) {
    std::filesystem::rename(beside, file, error);
  } else {
    error.assign(errno != 0 ? errno : EIO, std::generic_category());
  }
  if (error) {
    std::error_code ignored;
    std::filesystem::remove(beside, ignored);
    throw std::runtime_error(fmt::format("{}: cannot be written ({})", file.string(), error.message()));
  }
}

void from_buffer(const OIIO::ImageBuf& buffer, Image& image) {
  const auto* samples = static_cast<const float*>(buffer.localpixels());
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      for (int c = 0; c < image.channels(); ++c) {
        image.at(c, x, y) = *samples++;
      }
    }
  }
}

}  // namespace

void write_image(const Image& image, const std::filesystem::path& file, std::span<const ImageMap> maps) {
  const std::string extension = extension_of(file);
  if (extension != ".png" && extension != ".exr") {
    reject(file, fmt::format("cannot write \"{}\" files; expected .png or .exr", extension));
  }
  if (maps.empty() && image.channels() != 1 && image.channels() != 3) {
    reject(file, fmt::format("cannot write a picture of {} channels; expected 1 or 3", image.channels()));
  }
  if (!maps.empty() &&
      (extension != ".exr" || channel_names(maps).size() != static_cast<std::size_t>(image.channels()))) {
    reject(file, fmt::format("cannot write {} channels as maps of {}; expected as many, and .exr", image.channels(),
                             channel_names(maps).size()));
  }
  write_bytes(encode(image, extension, maps), file);
}

void write_png_16(const Image& image, const std::filesystem::path& file) {
  write_bytes(encode(image, ".png", {}, OIIO::TypeDesc::UINT16), file);
}

void draw_text(Image& image, int x, int y, const std::string& text, int font_size, float value) {
  OIIO::ImageBuf buffer = to_buffer(image);
  const std::vector<float> color(static_cast<std::size_t>(image.channels()), value);
  if (!OIIO::ImageBufAlgo::render_text(buffer, x, y, text, font_size, font, color)) {
    throw std::runtime_error(fmt::format("text \"{}\" cannot be drawn ({}); install the package fonts-dejavu-core",
                                         text, buffer.geterror()));
  }
  from_buffer(buffer, image);
}

Extent text_extent(const std::string& text, int font_size) {
  const OIIO::ROI roi = OIIO::ImageBufAlgo::text_size(text, font_size, font);
  if (!roi.defined()) {
    throw std::runtime_error(
        fmt::format("text \"{}\" cannot be measured; install the package fonts-dejavu-core", text));
  }
  return {roi.width(), roi.height()};
}

Image resize(const Image& image, Extent size) {
  Image result(size, image.channels());
  if (size.width >= image.width() && size.height >= image.height()) {
    for (int c = 0; c < image.channels(); ++c) {
      for (int y = 0; y < size.height; ++y) {
        const int from_y = static_cast<int>(std::int64_t{y} * image.height() / size.height);
        for (int x = 0; x < size.width; ++x) {
          result.at(c, x, y) = image.at(c, static_cast<int>(std::int64_t{x} * image.width() / size.width), from_y);
        }
      }
    }
    return result;
  }
  OIIO::ImageBuf shrunk(OIIO::ImageSpec(size.width, size.height, image.channels(), OIIO::TypeDesc::FLOAT));
  if (!OIIO::ImageBufAlgo::resize(shrunk, to_buffer(image), "lanczos3")) {
    throw std::runtime_error(
        fmt::format("picture cannot be resized to {}x{} ({})", size.width, size.height, shrunk.geterror()));
  }
  from_buffer(shrunk, result);
  return result;
}

std::string image_library_version() { return OIIO_VERSION_STRING; }

}  // namespace textonbench
