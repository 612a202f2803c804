#include "methods/base/image_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace textonbench {
namespace {

void copy_channel(const Image& from, int source, Image& to, int target, int left = 0) {
  for (int y = 0; y < from.height(); ++y) {
    std::ranges::copy(from.row(source, y), to.row(target, y).begin() + left);
  }
}

}  // namespace

std::vector<std::string> channel_names(std::span<const ImageMap> maps) {
  std::vector<std::string> names;
  for (const ImageMap& map : maps) {
    for (const char channel : std::string(map.channels == 1 ? "Y" : "RGB")) {
      names.push_back(fmt::format("{}.{}", map.name, channel));
    }
  }
  return names;
}

std::vector<ImageMap> maps_of_channels(std::span<const std::string> names) {
  std::vector<ImageMap> maps;
  for (const std::string& name : names) {
    const std::size_t dot = name.rfind('.');
    if (dot == std::string::npos || dot == 0) {
      return {};
    }
    const std::string map = name.substr(0, dot);
    if (maps.empty() || maps.back().name != map) {
      maps.push_back({map, 0});
    }
    ++maps.back().channels;
  }
  const bool plain =
      std::ranges::all_of(maps, [](const ImageMap& map) { return map.channels == 1 || map.channels == 3; });
  return plain && maps.size() > 1 ? maps : std::vector<ImageMap>{};
}

Image stack_images(std::span<const Image> images) {
  if (images.empty()) {
    throw std::invalid_argument("a stack of no images: expected at least one");
  }
  const Extent extent = images.front().extent();
  int channels = 0;
  for (const Image& image : images) {
    if (image.extent() != extent) {
      throw std::invalid_argument(fmt::format("a stack of images of {}x{} and {}x{} pixels: expected one size",
                                              extent.width, extent.height, image.width(), image.height()));
    }
    channels += image.channels();
  }
  if (channels > Image::max_channels) {
    throw std::invalid_argument(
        fmt::format("a stack of {} channels: expected at most {}", channels, Image::max_channels));
  }
  Image stack = Image::uninitialized(extent, channels);
  int next = 0;
  for (const Image& image : images) {
    for (int c = 0; c < image.channels(); ++c) {
      copy_channel(image, c, stack, next++);
    }
  }
  return stack;
}

std::vector<Image> split_maps(const Image& stack, std::span<const ImageMap> maps) {
  int channels = 0;
  for (const ImageMap& map : maps) {
    channels += map.channels;
  }
  if (channels != stack.channels()) {
    throw std::invalid_argument(
        fmt::format("maps of {} channels in all and an image of {}: expected as many", channels, stack.channels()));
  }
  std::vector<Image> pictures;
  pictures.reserve(maps.size());
  int next = 0;
  for (const ImageMap& map : maps) {
    Image& picture = pictures.emplace_back(Image::uninitialized(stack.extent(), map.channels));
    for (int c = 0; c < map.channels; ++c) {
      copy_channel(stack, next++, picture, c);
    }
  }
  return pictures;
}

Image side_by_side(const Image& stack, std::span<const ImageMap> maps) {
  constexpr int gap = 2;
  const std::vector<Image> pictures = split_maps(stack, maps);
  const int step = stack.width() + gap;
  Image sheet({static_cast<int>(maps.size()) * step - gap, stack.height()}, 3);
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < sheet.height(); ++y) {
      std::ranges::fill(sheet.row(c, y), 1.0F);
    }
    int left = 0;
    for (const Image& picture : pictures) {
      copy_channel(picture, std::min(c, picture.channels() - 1), sheet, c, left);
      left += step;
    }
  }
  return sheet;
}

}  // namespace textonbench
