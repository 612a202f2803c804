// Masks by name, for the option `mask` of the conditional methods.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "methods/base/mask.h"

namespace textonbench {

/// Missing pixels of a picture of size `extent`, as described:
///
///   "square"       one square in the middle
///   "holes"        squares of 20 x 20 pixels, scattered without touching
///   "ragged"       where a smooth random field is above a level
///   "pixels"       single pixels at random
///   "lines"        straight scratches, two pixels wide
///   "rect:x,y,w,h" a rectangle, or several, separated by ";"
///   otherwise      the path of a picture of that size, whose non-zero pixels are missing
///
/// The first five miss `percent` percent of the pixels, up to what whole shapes allow. Their random numbers are fixed.
/// Throws std::invalid_argument with the description and what was expected: a rectangle outside the picture, a picture
/// of another size (both sizes are told), a file that cannot be read, a percentage outside (0, 100).
Mask make_mask(const std::string& description, double percent, Extent extent);

/// The file that a description names, if it names one.
std::optional<std::filesystem::path> mask_file(std::string_view description);

/// "x,y,w,h" with w, h >= 1. Throws std::invalid_argument quoting the text.
Rectangle parse_rectangle(std::string_view text);

}  // namespace textonbench
