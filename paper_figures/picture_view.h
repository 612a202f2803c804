// How a picture is brought to the size of its place.
#pragma once

#include "methods/base/image.h"

namespace textonbench {

/// A texture is shown by its central part, pixel for pixel, so that its grain stays what it is; a spectrum must be seen
/// whole, so it is shrunk.
enum class PictureFit { window, whole };

/// Size of a picture of size `size` in a place of `side` x `side` pixels: never larger than the place, never enlarged.
Extent shown_size(Extent size, int side, PictureFit fit);

/// The picture at that size.
Image shown_picture(const Image& picture, int side, PictureFit fit);

}  // namespace textonbench
