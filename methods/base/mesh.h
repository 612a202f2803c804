// Triangle meshes: what a noise on a surface is drawn on.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

namespace textonbench {

/// Vertices with a unit normal each. Edges may be shared by any number of triangles: a noise asks a surface for points
/// and normals, never for neighbors.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3d> normals;
  /// Places on a plane, one a vertex, or none: vertices on both sides of a seam are two.
  std::vector<Eigen::Vector2d> coordinates;
  std::vector<std::array<std::int32_t, 3>> triangles;  ///< counterclockwise seen from outside
};

/// Reads a Wavefront OBJ file. Polygons are cut into triangles, triangles without area are left out, and where a corner
/// has no normal it gets its vertex' mean over the triangles around, weighted by their angles there. Texture
/// coordinates are kept where all corners have them, the second one downwards. Materials and lines are ignored. Throws
/// std::invalid_argument, naming the file, when it cannot be read or parsed, refers to a vertex or normal that does not
/// exist, holds a number that is not finite, has no triangle with an area, or a vertex whose triangles' normals cancel.
TriangleMesh read_obj(const std::filesystem::path& file);

/// Unit sphere around the origin: `rows` bands of latitude, twice as many of longitude. Coordinates are longitude and
/// latitude, which grows downwards, in radians. rows >= 2.
TriangleMesh sphere_mesh(int rows);

/// Torus around the z axis, circle of radius `tube` around one of radius 1. 0 < tube < 1, rows >= 3 around the tube,
/// twice as many around the axis. Coordinates are lengths along the circle around the axis and around the tube.
TriangleMesh torus_mesh(double tube, int rows);

/// The "sphere" or "torus" that pictures show. Throws std::invalid_argument for another name.
TriangleMesh solid_mesh(std::string_view name);

}  // namespace textonbench
