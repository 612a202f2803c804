#include "methods/base/surface_view.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace textonbench {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// What the z buffer keeps of a pixel: its triangle and the weights of the corners.
struct Hit {
  double depth = -std::numeric_limits<double>::infinity();
  std::int32_t triangle = -1;
  double b = 0, c = 0;
};

/// Vertices in picture coordinates: x right, y down, z towards the viewer.
std::vector<Vector3d> project(const std::vector<Vector3d>& vertices, Extent size, double tilt) {
  const Matrix3d rotation = view_rotation(tilt);
  const Vector3d center((size.width - 1) / 2.0, (size.height - 1) / 2.0, 0);
  std::vector<Vector3d> projected;
  projected.reserve(vertices.size());
  for (const Vector3d& vertex : vertices) {
    projected.emplace_back(rotation * vertex + center);
  }
  return projected;
}

void draw_triangle(const std::array<Vector3d, 3>& p, std::int32_t index, Extent size, std::vector<Hit>& hits) {
  const auto [left, right] = std::minmax({p[0].x(), p[1].x(), p[2].x()});
  const auto [top, bottom] = std::minmax({p[0].y(), p[1].y(), p[2].y()});
  const Vector3d ab = p[1] - p[0];
  const Vector3d ac = p[2] - p[0];
  const double area = ab.x() * ac.y() - ab.y() * ac.x();
  if (area == 0) {
    return;  // seen edge-on
  }
  const int last_y = std::min(size.height - 1, static_cast<int>(std::floor(bottom)));
  const int last_x = std::min(size.width - 1, static_cast<int>(std::floor(right)));
  for (int y = std::max(0, static_cast<int>(std::ceil(top))); y <= last_y; ++y) {
    for (int x = std::max(0, static_cast<int>(std::ceil(left))); x <= last_x; ++x) {
      const double dx = x - p[0].x();
      const double dy = y - p[0].y();
      const double b = (dx * ac.y() - dy * ac.x()) / area;
      const double c = (dy * ab.x() - dx * ab.y()) / area;
      const double depth = p[0].z() + b * ab.z() + c * ac.z();
      Hit& hit = hits[static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(x)];
      if (b >= 0 && c >= 0 && b + c <= 1 && depth > hit.depth) {
        hit = {depth, index, b, c};
      }
    }
  }
}

}  // namespace

SurfacePoint surface_point(const Vector3d& position, const Vector3d& normal) {
  Vector3d east = Vector3d::UnitZ().cross(normal);
  const double length = east.norm();
  east = length > 1e-9 ? Vector3d(east / length) : Vector3d::UnitX();
  return {.position = position, .u1 = east, .u2 = normal.cross(east), .normal = normal};
}

std::vector<Vector3d> place_in_ball(const TriangleMesh& mesh, double radius) {
  Vector3d low = mesh.vertices.front();
  Vector3d high = low;
  for (const Vector3d& vertex : mesh.vertices) {
    low = low.cwiseMin(vertex);
    high = high.cwiseMax(vertex);
  }
  const Vector3d middle = (low + high) / 2;
  double reach = 0;
  for (const Vector3d& vertex : mesh.vertices) {
    reach = std::max(reach, (vertex - middle).norm());
  }
  std::vector<Vector3d> vertices;
  vertices.reserve(mesh.vertices.size());
  for (const Vector3d& vertex : mesh.vertices) {
    vertices.emplace_back((vertex - middle) * (radius / reach));
  }
  return vertices;
}

double picture_radius(Extent size) { return 0.48 * std::min(size.width, size.height); }

Matrix3d view_rotation(double tilt, double azimuth) {
  // The viewer looks from +x along −x; y is to the right and z up.
  Matrix3d rotation;
  rotation << 0, 1, 0,                     //
      std::sin(tilt), 0, -std::cos(tilt),  //
      std::cos(tilt), 0, std::sin(tilt);
  if (azimuth == 0) return rotation;
  return rotation * Eigen::AngleAxisd(azimuth, Vector3d::UnitZ()).toRotationMatrix();
}

std::vector<ViewedPoint> view_mesh(const TriangleMesh& mesh, Extent size, double radius, double tilt) {
  const std::vector<Vector3d> vertices = place_in_ball(mesh, radius);
  const std::vector<Vector3d> projected = project(vertices, size, tilt);

  std::vector<Hit> hits(static_cast<std::size_t>(size.area()));
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& triangle = mesh.triangles[i];
    const auto at = [&](std::size_t corner) { return projected[static_cast<std::size_t>(triangle[corner])]; };
    draw_triangle({at(0), at(1), at(2)}, static_cast<std::int32_t>(i), size, hits);
  }

  const Vector3d sight(std::cos(tilt), 0, std::sin(tilt));
  std::vector<ViewedPoint> points;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const Hit& hit =
          hits[static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(x)];
      if (hit.triangle < 0) {
        continue;
      }
      const auto& triangle = mesh.triangles[static_cast<std::size_t>(hit.triangle)];
      const auto mixed = [&](const std::vector<Vector3d>& corners) -> Vector3d {
        const auto at = [&](std::size_t corner) { return corners[static_cast<std::size_t>(triangle[corner])]; };
        return (1 - hit.b - hit.c) * at(0) + hit.b * at(1) + hit.c * at(2);
      };
      const Vector3d normal = mixed(mesh.normals).normalized();
      points.push_back(
          {.x = x, .y = y, .point = surface_point(mixed(vertices), normal), .facing = std::abs(normal.dot(sight))});
    }
  }
  return points;
}

}  // namespace textonbench
