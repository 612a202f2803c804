// The text format of the authors of Texton Noise (CGF 2017) for a texton:
//
//   TEXTON
//   1                    version of the format
//   1                    order of the B-spline that the coefficients belong to
//   0.18 0.36 0.34       mean of the texture, red green blue, in [0, 1]
//   64 64                width and height, frame included
//   0.0 0.0 0.0          width x height lines of three coefficients, row by row, the bottom row first
//   …
//   grass.png 128x128    a last line that names the exemplar
//
// A texton of order n has a frame of floor((n + 1) / 2) zeros on every side.
#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "methods/base/image.h"

namespace textonbench {

struct TextonFile {
  int order = 0;
  std::array<double, 3> mean{};
  Image coefficients;  ///< three channels, frame included, top row first
  std::string source;  ///< the last line
};

/// Throws std::invalid_argument with file, line, what stands there and what was expected: for a file that is no texton,
/// another version, a text that ends early or goes on, a number that is not finite, or a frame that is not zero.
TextonFile read_texton_file(const std::filesystem::path& file);

/// Writes the file as a whole, with enough digits that reading it gives the same float32 coefficients. Throws
/// std::invalid_argument for other than three channels, a frame that is not zero or a number that is not finite, and
/// std::runtime_error when the file cannot be written.
void write_texton_file(const TextonFile& texton, const std::filesystem::path& file);

}  // namespace textonbench
