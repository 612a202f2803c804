#include "paper_figures/picture_view.h"

#include <algorithm>
#include <cstdint>

#include "methods/base/image_io.h"

namespace textonbench {

Extent shown_size(Extent size, int side, PictureFit fit) {
  if (fit == PictureFit::window) return {std::min(size.width, side), std::min(size.height, side)};
  const int longest = std::max(size.width, size.height);
  if (longest <= side) return size;
  const auto shrunk = [&](int s) { return std::max(1, static_cast<int>(std::int64_t{s} * side / longest)); };
  return {shrunk(size.width), shrunk(size.height)};
}

Image shown_picture(const Image& picture, int side, PictureFit fit) {
  const Extent size = shown_size(picture.extent(), side, fit);
  if (size == picture.extent()) return picture;
  if (fit == PictureFit::whole) return resize(picture, size);
  return crop(picture, (picture.width() - size.width) / 2, (picture.height() - size.height) / 2, size);
}

}  // namespace textonbench
