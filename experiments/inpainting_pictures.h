// Pictures that show how a picture was inpainted (Lectures 2022, "Inpainting of a Gaussian texture").
#pragma once

#include <span>
#include <string>
#include <vector>

#include "methods/base/image.h"
#include "methods/base/mask.h"

namespace textonbench {

/// The picture where `shown` holds, and elsewhere black or white, whichever is farther from the mean of what is shown;
/// pixels that are not shown are not read. At least one is.
Image only_pixels(const Image& picture, const Mask& shown);

/// The pixels that are not in the mask.
Image without_pixels(const Image& picture, const Mask& hidden);

/// mean + (sample − kriging) at the missing pixels and the mean elsewhere: what the sample adds to the kriging
/// component, shown where it can be seen. `mean` has a value a channel.
Image innovation_picture(const Image& sample, const Image& kriging, const Mask& missing, std::span<const double> mean);

struct CaptionedPicture {
  std::string caption;
  Image picture;
};

/// The pictures, framed, from left to right on white under their captions; small ones are enlarged by a whole number,
/// large ones reduced to 512 pixels. All have the size of the first, and 1 or 3 channels, as many as it. Throws
/// std::invalid_argument otherwise, and for none.
Image picture_strip(std::span<const CaptionedPicture> pictures);

}  // namespace textonbench
