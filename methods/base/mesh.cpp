#include "methods/base/mesh.h"

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

namespace textonbench {
namespace {

using Eigen::Vector3d;

/// A mesh whose vertices may still lack normals.
struct OpenMesh {
  TriangleMesh mesh;
  std::vector<bool> has_normal;
};

Vector3d vector_at(const std::vector<tinyobj::real_t>& numbers, int index, std::string_view what,
                   const std::filesystem::path& file) {
  const std::size_t count = numbers.size() / 3;
  if (index < 0 || static_cast<std::size_t>(index) >= count) {
    throw std::invalid_argument(
        fmt::format("{}: a face refers to {} {}; expected 1 to {}", file.string(), what, index + 1, count));
  }
  const auto first = 3 * static_cast<std::size_t>(index);
  Vector3d vector(numbers[first], numbers[first + 1], numbers[first + 2]);
  if (!vector.allFinite()) {
    throw std::invalid_argument(fmt::format("{}: {} {} is ({}, {}, {}); expected finite numbers", file.string(), what,
                                            index + 1, vector.x(), vector.y(), vector.z()));
  }
  return vector;
}

/// Corners that share position and normal become one vertex.
class MeshBuilder {
 public:
  MeshBuilder(const tinyobj::attrib_t& attributes, std::filesystem::path file)
      : attributes_(attributes), file_(std::move(file)) {}

  void add(const std::array<tinyobj::index_t, 3>& corners) {
    std::array<std::int32_t, 3> triangle{};
    std::ranges::transform(corners, triangle.begin(), [&](const tinyobj::index_t& corner) { return vertex(corner); });
    const auto point = [&](int i) {
      return open_.mesh.vertices[static_cast<std::size_t>(triangle[static_cast<std::size_t>(i)])];
    };
    const Vector3d a = point(1) - point(0);
    const Vector3d b = point(2) - point(0);
    // Below this the normal is nothing but rounding of the file's single precision.
    if (a.cross(b).norm() > 1e-6 * std::max(a.squaredNorm(), b.squaredNorm())) {
      open_.mesh.triangles.push_back(triangle);
    }
  }

  OpenMesh take() { return std::move(open_); }

 private:
  std::int32_t vertex(const tinyobj::index_t& corner) {
    const auto found = known_.find({corner.vertex_index, corner.normal_index});
    if (found != known_.end()) {
      return found->second;
    }
    const auto index = static_cast<std::int32_t>(open_.mesh.vertices.size());
    open_.mesh.vertices.push_back(vector_at(attributes_.vertices, corner.vertex_index, "vertex", file_));
    Vector3d normal = Vector3d::Zero();
    if (corner.normal_index >= 0) {
      normal = vector_at(attributes_.normals, corner.normal_index, "normal", file_).normalized();
    }
    open_.mesh.normals.push_back(normal);
    open_.has_normal.push_back(normal.squaredNorm() > 0);
    known_.emplace(std::pair{corner.vertex_index, corner.normal_index}, index);
    return index;
  }

  const tinyobj::attrib_t& attributes_;
  std::filesystem::path file_;
  OpenMesh open_;
  std::map<std::pair<int, int>, std::int32_t> known_;
};

double angle_between(const Vector3d& a, const Vector3d& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

void fill_normals(OpenMesh& open, const std::filesystem::path& file) {
  std::vector<Vector3d> sums(open.mesh.vertices.size(), Vector3d::Zero());
  std::vector<bool> used(open.mesh.vertices.size(), false);
  for (const auto& triangle : open.mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto here = static_cast<std::size_t>(triangle[i]);
      const Vector3d a = open.mesh.vertices[static_cast<std::size_t>(triangle[(i + 1) % 3])] - open.mesh.vertices[here];
      const Vector3d b = open.mesh.vertices[static_cast<std::size_t>(triangle[(i + 2) % 3])] - open.mesh.vertices[here];
      sums[here] += angle_between(a, b) * a.cross(b).normalized();
      used[here] = true;
    }
  }
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (open.has_normal[i] || !used[i]) {
      continue;
    }
    if (sums[i].norm() < 1e-6) {
      const Vector3d& at = open.mesh.vertices[i];
      throw std::invalid_argument(
          fmt::format("{}: the triangles around the vertex ({}, {}, {}) face opposite ways, so it has no normal; "
                      "expected triangles all counterclockwise from outside, or normals in the file",
                      file.string(), at.x(), at.y(), at.z()));
    }
    open.mesh.normals[i] = sums[i].normalized();
  }
}

/// Grid of rows x columns points, closed around the columns, and around the rows too if asked.
template <class Point, class Normal>
TriangleMesh grid_mesh(int rows, int columns, bool closed, const Point& point, const Normal& normal) {
  TriangleMesh mesh;
  const int lines = closed ? rows : rows + 1;
  for (int i = 0; i < lines; ++i) {
    for (int j = 0; j < columns; ++j) {
      const double u = static_cast<double>(i) / rows;
      const double v = static_cast<double>(j) / columns;
      mesh.vertices.push_back(point(u, v));
      mesh.normals.push_back(normal(u, v));
    }
  }
  const auto index = [&](int i, int j) { return (i % lines) * columns + j % columns; };
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      mesh.triangles.push_back({index(i, j), index(i + 1, j), index(i + 1, j + 1)});
      mesh.triangles.push_back({index(i, j), index(i + 1, j + 1), index(i, j + 1)});
    }
  }
  return mesh;
}

constexpr double turn = 2 * std::numbers::pi;

}  // namespace

TriangleMesh read_obj(const std::filesystem::path& file) {
  tinyobj::ObjReaderConfig config;
  config.triangulate = true;
  config.vertex_color = false;
  tinyobj::ObjReader reader;
  if (!std::filesystem::is_regular_file(file) || !reader.ParseFromFile(file.string(), config)) {
    std::string reason = reader.Error();
    std::erase(reason, '\n');
    throw std::invalid_argument(fmt::format("{}: cannot be read as a Wavefront OBJ mesh{}{}", file.string(),
                                            reason.empty() ? "" : ": ", reason));
  }
  MeshBuilder builder(reader.GetAttrib(), file);
  for (const tinyobj::shape_t& shape : reader.GetShapes()) {
    for (std::size_t i = 0; i + 2 < shape.mesh.indices.size(); i += 3) {
      builder.add({shape.mesh.indices[i], shape.mesh.indices[i + 1], shape.mesh.indices[i + 2]});
    }
  }
  OpenMesh open = builder.take();
  if (open.mesh.triangles.empty()) {
    throw std::invalid_argument(
        fmt::format("{}: no triangle with an area; expected a mesh with at least one face", file.string()));
  }
  fill_normals(open, file);
  return std::move(open.mesh);
}

TriangleMesh sphere_mesh(int rows) {
  const auto point = [](double u, double v) {
    const double latitude = u * turn / 2;
    return Vector3d(std::sin(latitude) * std::cos(v * turn), std::sin(latitude) * std::sin(v * turn),
                    std::cos(latitude));
  };
  return grid_mesh(rows, 2 * rows, false, point, point);
}

TriangleMesh torus_mesh(double tube, int rows) {
  const auto normal = [](double u, double v) {
    return Vector3d(std::cos(u * turn) * std::cos(v * turn), std::cos(u * turn) * std::sin(v * turn),
                    -std::sin(u * turn));
  };
  const auto point = [&](double u, double v) -> Vector3d {
    return Vector3d(std::cos(v * turn), std::sin(v * turn), 0) + tube * normal(u, v);
  };
  return grid_mesh(rows, 2 * rows, true, point, normal);
}

}  // namespace textonbench
