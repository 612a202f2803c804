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
/// A picture's alpha channel counts for nothing, a sample that is not a number for missing.
///
/// The first five miss `percent` percent of the pixels: "ragged", "pixels" and "lines" exactly (rounded, and so that
/// some pixel is known and some missing); "square" to a whole side, at most two less than the shorter side of the
/// picture; "holes" to whole squares (of a quarter of the shorter side where that is less than 20), 8 pixels apart
/// where they find room, less where they do not, down to 1, which is the case of about half the picture. Their random
/// numbers are fixed.
///
/// Throws std::invalid_argument with the description and what was expected: a rectangle outside the picture, a picture
/// of another size (both sizes are told), a file that cannot be read, a percentage outside (0, 100), a picture smaller
/// than 3x3 for a shape.
Mask make_mask(const std::string& description, double percent, Extent extent);

/// The file that a description names: any that is no shape and no list of rectangles.
std::optional<std::filesystem::path> mask_file(std::string_view description);

/// "x,y,w,h" with w, h >= 1. Throws std::invalid_argument quoting the text.
Rectangle parse_rectangle(std::string_view text);

}  // namespace textonbench
