#include "methods/base/mesh.h"

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
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
  std::vector<std::size_t> position;  ///< of each vertex, its number in the file
  bool has_coordinates = true;
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

/// Corners that share position, normal and coordinates become one vertex.
class MeshBuilder {
 public:
  MeshBuilder(const tinyobj::attrib_t& attributes, std::filesystem::path file)
      : attributes_(attributes), file_(std::move(file)), latest_(attributes.vertices.size() / 3, -1) {}

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
    const Vector3d position = vector_at(attributes_.vertices, corner.vertex_index, "vertex", file_);
    // The vertices made of one position are a list, from the latest on.
    std::int32_t& latest = latest_[static_cast<std::size_t>(corner.vertex_index)];
    for (std::int32_t known = latest; known >= 0; known = made_[static_cast<std::size_t>(known)].before) {
      const Made& made = made_[static_cast<std::size_t>(known)];
      if (made.normal == corner.normal_index && made.coordinate == corner.texcoord_index) return known;
    }
    const auto index = static_cast<std::int32_t>(made_.size());
    made_.push_back({corner.normal_index, corner.texcoord_index, latest});
    latest = index;
    open_.mesh.vertices.push_back(position);
    open_.position.push_back(static_cast<std::size_t>(corner.vertex_index));
    Vector3d normal = Vector3d::Zero();
    if (corner.normal_index >= 0) {
      normal = vector_at(attributes_.normals, corner.normal_index, "normal", file_).normalized();
    }
    open_.mesh.normals.push_back(normal);
    open_.has_normal.push_back(normal.squaredNorm() > 0);
    open_.mesh.coordinates.push_back(coordinate(corner.texcoord_index));
    return index;
  }

  Eigen::Vector2d coordinate(int index) {
    if (index < 0) {
      open_.has_coordinates = false;
      return Eigen::Vector2d::Zero();
    }
    const std::size_t count = attributes_.texcoords.size() / 2;
    if (static_cast<std::size_t>(index) >= count) {
      throw std::invalid_argument(fmt::format("{}: a face refers to texture coordinate {}; expected 1 to {}",
                                              file_.string(), index + 1, count));
    }
    const auto first = 2 * static_cast<std::size_t>(index);
    Eigen::Vector2d place(attributes_.texcoords[first], -attributes_.texcoords[first + 1]);
    if (!place.allFinite()) {
      throw std::invalid_argument(fmt::format("{}: texture coordinate {} is ({}, {}); expected finite numbers",
                                              file_.string(), index + 1, place.x(), -place.y()));
    }
    return place;
  }

  struct Made {
    int normal, coordinate;
    std::int32_t before;  ///< vertex of the same position, or −1
  };
  const tinyobj::attrib_t& attributes_;
  std::filesystem::path file_;
  OpenMesh open_;
  std::vector<Made> made_;
  std::vector<std::int32_t> latest_;
};

double angle_between(const Vector3d& a, const Vector3d& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

/// A position on a seam of the coordinates is several vertices, which get one normal.
void fill_normals(OpenMesh& open, std::size_t positions, const std::filesystem::path& file) {
  std::vector<Vector3d> sums(positions, Vector3d::Zero());
  std::vector<bool> used(open.mesh.vertices.size(), false);
  for (const auto& triangle : open.mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto here = static_cast<std::size_t>(triangle[i]);
      const Vector3d a = open.mesh.vertices[static_cast<std::size_t>(triangle[(i + 1) % 3])] - open.mesh.vertices[here];
      const Vector3d b = open.mesh.vertices[static_cast<std::size_t>(triangle[(i + 2) % 3])] - open.mesh.vertices[here];
      sums[open.position[here]] += angle_between(a, b) * a.cross(b).normalized();
      used[here] = true;
    }
  }
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (open.has_normal[i] || !used[i]) {
      continue;
    }
    const Vector3d& sum = sums[open.position[i]];
    if (sum.norm() < 1e-6) {
      const Vector3d& at = open.mesh.vertices[i];
      throw std::invalid_argument(
          fmt::format("{}: the triangles around the vertex ({}, {}, {}) face opposite ways, so it has no normal; "
                      "expected triangles all counterclockwise from outside, or normals in the file",
                      file.string(), at.x(), at.y(), at.z()));
    }
    open.mesh.normals[i] = sum.normalized();
  }
}

/// Grid of rows x columns squares that closes on itself along its columns, and along its rows if `closed`; otherwise
/// its first and last rows are points. A vertex more along each closes the coordinates.
template <class Point, class Normal>
TriangleMesh grid_mesh(int rows, int columns, bool closed, const Point& point, const Normal& normal,
                       const Eigen::Vector2d& lengths) {
  TriangleMesh mesh;
  for (int i = 0; i <= rows; ++i) {
    for (int j = 0; j <= columns; ++j) {
      const double u = static_cast<double>(closed ? i % rows : i) / rows;
      const double v = static_cast<double>((j + columns / 2) % columns) / columns;
      mesh.vertices.push_back(point(u, v));
      mesh.normals.push_back(normal(u, v));
      mesh.coordinates.emplace_back(lengths.x() * j / columns, lengths.y() * i / rows);
    }
  }
  const auto index = [&](int i, int j) { return i * (columns + 1) + j; };
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
  fill_normals(open, reader.GetAttrib().vertices.size() / 3, file);
  if (!open.has_coordinates) open.mesh.coordinates.clear();
  return std::move(open.mesh);
}

TriangleMesh sphere_mesh(int rows) {
  const auto point = [](double u, double v) {
    const double latitude = u * turn / 2;
    return Vector3d(std::sin(latitude) * std::cos(v * turn), std::sin(latitude) * std::sin(v * turn),
                    std::cos(latitude));
  };
  return grid_mesh(rows, 2 * rows, false, point, point, {turn, turn / 2});
}

TriangleMesh torus_mesh(double tube, int rows) {
  const auto normal = [](double u, double v) {
    return Vector3d(std::cos(u * turn) * std::cos(v * turn), std::cos(u * turn) * std::sin(v * turn),
                    -std::sin(u * turn));
  };
  const auto point = [&](double u, double v) -> Vector3d {
    return Vector3d(std::cos(v * turn), std::sin(v * turn), 0) + tube * normal(u, v);
  };
  return grid_mesh(rows, 2 * rows, true, point, normal, {turn, tube * turn});
}

TriangleMesh solid_mesh(std::string_view name) {
  if (name == "sphere") return sphere_mesh(256);
  if (name == "torus") return torus_mesh(0.45, 256);
  throw std::invalid_argument(fmt::format("solid {}: expected sphere or torus", name));
}

}  // namespace textonbench
