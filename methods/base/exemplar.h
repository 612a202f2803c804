// A texture photograph with its identity.
#pragma once

#include <string>

#include "methods/base/image.h"

namespace textonbench {

/// Pixels in [0,1] (1 or 3 channels) under a name; `sha256` (64 hexadecimal digits) identifies what was read.
struct Exemplar {
  std::string name;
  Image pixels;
  std::string sha256;
};

/// Throws std::invalid_argument, naming the exemplar, when no texture model can be fitted: no pixels, a side of one
/// pixel, a channel count other than 1 or 3, a sample that is not finite (its place and value are told), or no
/// variation at all.
void require_usable(const Exemplar& exemplar);

}  // namespace textonbench
