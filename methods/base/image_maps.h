// Stacks of maps: several pictures of one surface (color, normals, height) as the channels of one image.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "methods/base/image.h"

namespace textonbench {

/// One picture of a stack, gray or color.
struct ImageMap {
  std::string name;
  int channels = 0;  ///< 1 or 3
  friend bool operator==(const ImageMap&, const ImageMap&) = default;
};

/// Names of the channels in order, as in EXR files: "albedo.R", "albedo.G", "albedo.B", "height.Y".
std::vector<std::string> channel_names(std::span<const ImageMap> maps);

/// The maps of channels with such names: each is a run of one or three names that agree up to the last dot. Empty
/// unless there are at least two maps and all names are of maps.
std::vector<ImageMap> maps_of_channels(std::span<const std::string> names);

/// The channels of the images in order. Throws std::invalid_argument for no image, images of different sizes and more
/// than Image::max_channels channels.
Image stack_images(std::span<const Image> images);

/// The picture of each map. Throws std::invalid_argument when the maps have not as many channels as the image.
std::vector<Image> split_maps(const Image& stack, std::span<const ImageMap> maps);

/// One color picture of all maps from left to right, two white columns between them. Throws as split_maps does.
Image side_by_side(const Image& stack, std::span<const ImageMap> maps);

}  // namespace textonbench
