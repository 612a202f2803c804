// Reading and writing pictures. Only this and image_io_tiled.h stand on OpenImageIO.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "methods/base/image.h"
#include "methods/base/image_maps.h"

namespace textonbench {

/// A picture as read: for 8 and 16 bit files the nearest float to level / highest level (palette expanded), as stored
/// for float files. No color conversion is applied, whatever profile or gamma the file names.
struct ReadResult {
  Image image;                      ///< 1 or 3 channels, or those of all maps
  std::vector<std::string> notes;   ///< what was changed on the way in: "dropped a constant alpha channel"
  std::vector<ImageMap> maps = {};  ///< of an EXR file with channels named as by image_maps.h, in the file's order
};

/// What is accepted besides.
struct ReadOptions {
  bool non_finite = false;  ///< samples that are NaN or infinite
  bool any_alpha = false;   ///< an alpha channel that varies: dropped like a constant one
};

/// Reads PNG, JPEG, TIFF or EXR: 8 and 16 bit, half and float, palette, grey, RGB, and RGBA or grey + alpha whose alpha
/// is constant (dropped, with a note); and a stack of maps without alpha, of at most 8 channels in all. Throws
/// std::invalid_argument naming the file and what was expected when it is missing, a folder, empty, not a picture,
/// truncated, larger than 2^28 samples, CMYK, of any other number of channels, has a varying alpha, or holds a sample
/// that is not finite.
ReadResult read_image(const std::filesystem::path& file, const ReadOptions& options = {});

/// Width, height and channels as read_image would deliver them, without decoding pixels where possible.
struct ImageInfo {
  Extent extent;
  int channels = 0;
};
ImageInfo read_image_info(const std::filesystem::path& file);

/// Writes 1 or 3 channels as 8-bit PNG (values clamped to [0,1], rounded to nearest), or float32 EXR (unclamped) by
/// extension; a stack of `maps` as EXR with the channel names of image_maps.h, which programs list by name. The file
/// appears complete or not at all (written beside, then renamed). Throws std::runtime_error naming the file when it
/// cannot be written, std::invalid_argument for another extension or number of channels.
void write_image(const Image& image, const std::filesystem::path& file, std::span<const ImageMap> maps = {});

/// Writes 1 or 3 channels of values in [0, 1] as numbers n / 65535 of a 16-bit PNG, as write_image() does.
void write_png_16(const Image& image, const std::filesystem::path& file);

/// Draws one line of text in DejaVu Sans; (x, y) is the left end of the baseline, `value` the gray level in [0,1].
/// Throws std::runtime_error when the font is not installed.
void draw_text(Image& image, int x, int y, const std::string& text, int font_size, float value = 0.0F);
/// Width and height in pixels that draw_text will cover.
Extent text_extent(const std::string& text, int font_size);

/// Resampled to `size` (Lanczos when shrinking, nearest neighbour when enlarging, so that pixels stay visible).
Image resize(const Image& image, Extent size);

/// Version string of the OpenImageIO library in use.
std::string image_library_version();

}  // namespace textonbench
