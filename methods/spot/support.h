// The support of a texton: which pixels its impacts may touch.
#pragma once

#include <cstdint>
#include <vector>

#include "methods/base/image.h"
#include "methods/base/params.h"

namespace textonbench {

/// A set S of pixels in its bounding box. Where on the torus the box lies does not matter to a noise.
struct Support {
  Extent box;
  std::vector<std::uint8_t> inside;  ///< row by row, box.area() entries: 1 in S, 0 outside
  std::int64_t pixels = 0;           ///< |S|, at least 1
};

Support square_support(int side);
Support rectangle_support(Extent box);
/// Pixels with x² + y² <= radius², (2 radius + 1)² pixels at most.
Support disc_support(int radius);
/// Pixels where any channel is not zero, cropped to their bounding box. Throws std::invalid_argument when there is
/// none.
Support mask_support(const Image& mask);

/// Pixels first … last − 1 of row y.
struct SupportRun {
  int y, first, last;
};
/// The longest runs that make up S, row by row from left to right.
std::vector<SupportRun> support_runs(const Support& support);

/// S as an image of its box: 1 inside, 0 outside.
Image support_image(const Support& support);

/// Area where a sum of B-splines of that order at the pixels of S may be other than zero: of the union of squares of
/// side order + 1 around them, (W + order) (H + order) for a rectangle.
double spline_support_area(const Support& support, int order);

/// The pixels of a torus image that S covers when pixel (0, 0) of its box lies at (left, top); zero off S. The box may
/// cross the border. Throws std::invalid_argument when the box is larger than the image.
Image crop_to_support(const Image& torus, int left, int top, const Support& support);

/// The options "support" (side of a square, radius of a disc; 0: the whole exemplar), "shape" (square|disc|mask) and
/// "mask" (an image file), and the support that they describe for an exemplar of that size. Throws
/// std::invalid_argument when it does not fit into the exemplar, is empty or its file cannot be read.
std::vector<ParamSpec> support_params(int default_support);
Support support_of(const Params& params, Extent exemplar);

}  // namespace textonbench
