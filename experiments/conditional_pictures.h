// Pictures of a law that is conditional on a picture.
#pragma once

#include <span>

#include "experiments/pictures.h"

namespace textonbench {

/// masked (missing pixels in magenta, or white on gray pictures), conditioning (the conditioning pixels on mid-gray),
/// kriging, innovation (plus the mean of the known pixels), unconditional (a sample given nothing) and hole (a close-up
/// of the first sample around the missing pixels). Each throws std::invalid_argument for a model that is not
/// conditional.
std::span<const PictureEntry> conditional_pictures();

/// The picture with its missing pixels marked.
Image marked(const Image& picture, const Mask& missing);
/// The pixels of the set, the others mid-gray.
Image only(const Image& picture, const Mask& shown);

}  // namespace textonbench
