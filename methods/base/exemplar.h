// A texture photograph with its identity.
#pragma once

#include <string>
#include <vector>

#include "methods/base/image.h"
#include "methods/base/image_maps.h"

namespace textonbench {

/// Pixels in [0,1] under a name; `sha256` (64 hexadecimal digits) identifies what was read. Gray has 1 channel, color
/// 3, a stack of maps as many as its maps in all.
struct Exemplar {
  std::string name;
  Image pixels;
  std::string sha256;
  std::vector<ImageMap> maps = {};  ///< of a stack, in the order of their channels; empty for one picture
};

/// Throws std::invalid_argument, naming the exemplar, when no texture model can be fitted: no pixels, a side of one
/// pixel, maps of other than the number of channels, a sample that is not finite (its place and value are told), or no
/// variation at all.
void require_usable(const Exemplar& exemplar);

}  // namespace textonbench
