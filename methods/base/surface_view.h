// Points of a surface under the pixels of a picture.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "methods/base/image.h"
#include "methods/base/mesh.h"

namespace textonbench {

/// A point with a right-handed orthonormal frame, `normal` its third axis.
struct SurfacePoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d u1 = Eigen::Vector3d::UnitX();
  Eigen::Vector3d u2 = Eigen::Vector3d::UnitY();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
};

/// The frame whose u1 points east (along z × normal) and u2 north: continuous but where the normal is ±z, which no
/// choice can avoid on a sphere. `normal` is a unit vector.
SurfacePoint surface_point(const Eigen::Vector3d& position, const Eigen::Vector3d& normal);

/// Vertices of a mesh moved and scaled, so that its bounding box is centered at the origin and they lie within a ball
/// of that radius.
std::vector<Eigen::Vector3d> place_in_ball(const TriangleMesh& mesh, double radius);

/// Radius of the ball that fills a picture.
double picture_radius(Extent size);

/// Rows: the directions to the right, down and towards the viewer of view_mesh(), after a turn of the object by
/// `azimuth` radians about the z axis.
Eigen::Matrix3d view_rotation(double tilt, double azimuth = 0);

struct ViewedPoint {
  int x = 0, y = 0;  ///< pixel
  SurfacePoint point;
  double facing = 0;  ///< |cosine| between normal and line of sight
};

/// The surface in orthographic projection, seen from a point above the x axis: the z axis points up and is tilted
/// towards the viewer by `tilt` radians. The mesh is placed in a ball of radius `radius`, in the unit of one pixel, and
/// positions are told in that scale, unrotated. One point for each pixel whose center the surface covers, the one
/// nearest to the viewer, row by row. Faces show both sides.
std::vector<ViewedPoint> view_mesh(const TriangleMesh& mesh, Extent size, double radius, double tilt);

}  // namespace textonbench
