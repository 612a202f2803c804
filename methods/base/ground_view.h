// The ground under the pixels of a picture: a plane seen in perspective.
#pragma once

#include <Eigen/Core>

#include "methods/base/image.h"

namespace textonbench {

/// A pinhole camera above the plane. It looks along −y, so that a texture lies on the plane as a picture on a table.
struct GroundViewOptions {
  double height = 64;    ///< of the camera above the plane, in pixels of the plane
  double pitch = 0.35;   ///< of the line of sight below the horizontal, radians in (0, π/2)
  double field = 1;      ///< horizontal angle of view, radians in (0, π)
  double furthest = 64;  ///< longest side of a pixel on the plane that is still shown, pixels of the plane
};

/// With u and v the distances of a pixel from the middle of the picture, to the right and down, f = (W/2) /
/// tan(field/2) the focal length in pixels and s = f sin(pitch) + v cos(pitch), it shows the point
///
///   (x, y) = (height / s) (u, v sin(pitch) − f cos(pitch)),   s > 0.
///
/// The ground ends where a pixel's footprint becomes longer than `furthest`, before the horizon s = 0, where it is
/// endless: so no footprint costs more than a known bound to filter.
class GroundView {
 public:
  /// Throws std::invalid_argument for an option out of range.
  GroundView(Extent size, const GroundViewOptions& options);

  /// Whether the pixel whose center is (x, y) shows ground, all of it nearer than the horizon.
  bool covers(double x, double y) const;
  /// The point of the plane under (x, y), for a point of a pixel that is covered.
  Eigen::Vector2d point(double x, double y) const;
  /// Its derivatives by x (first column) and y (second column), in pixels of the plane a pixel of the picture.
  Eigen::Matrix2d footprint(double x, double y) const;

 private:
  /// s, in pixels of the picture.
  double depth(double y) const { return focal_ * sine_ + (y - middle_.y()) * cosine_; }

  Eigen::Vector2d middle_;
  double height_, focal_, sine_, cosine_, furthest_;
};

}  // namespace textonbench
