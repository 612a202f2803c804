#include "methods/base/mesh.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <cmath>
#include <fstream>
#include <numbers>
#include <stdexcept>
#include <string>

#include "tests/base/scratch_folder.h"

namespace textonbench::mesh_test {

using Eigen::Vector3d;

double area_of(const TriangleMesh& mesh) {
  double area = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto at = [&](std::int32_t i) { return mesh.vertices[static_cast<std::size_t>(i)]; };
    area += (at(b) - at(a)).cross(at(c) - at(a)).norm() / 2;
  }
  return area;
}

// Every triangle turns the way its vertices' normals point.
void expect_outward(const TriangleMesh& mesh) {
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto at = [&](std::int32_t i) { return mesh.vertices[static_cast<std::size_t>(i)]; };
    const Vector3d face = (at(b) - at(a)).cross(at(c) - at(a));
    EXPECT_GE(face.dot(mesh.normals[static_cast<std::size_t>(a)]), -1e-12);
  }
}

std::filesystem::path obj_file(const ScratchFolder& folder, const std::string& text) {
  std::filesystem::path file = folder.path() / "mesh.obj";
  std::ofstream(file) << text;
  return file;
}

TEST(MeshTest, TheSphereHasItsAreaAndOutwardNormals) {
  const TriangleMesh mesh = sphere_mesh(100);
  EXPECT_NEAR(area_of(mesh), 4 * std::numbers::pi, 0.01);
  expect_outward(mesh);
}

TEST(MeshTest, TheTorusHasItsAreaAndOutwardNormals) {
  const TriangleMesh mesh = torus_mesh(0.4, 100);
  EXPECT_NEAR(area_of(mesh), 4 * std::numbers::pi * std::numbers::pi * 0.4, 0.02);
  expect_outward(mesh);
}

TEST(MeshTest, MissingNormalsAreThoseOfTheTrianglesAround) {
  const ScratchFolder folder;
  const TriangleMesh mesh = read_obj(obj_file(folder, "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"));
  EXPECT_EQ(mesh.triangles.size(), 2U);
  ASSERT_EQ(mesh.normals.size(), 4U);
  for (const Vector3d& normal : mesh.normals) {
    EXPECT_NEAR((normal - Vector3d(0, 0, 1)).norm(), 0, 1e-12);
  }
}

TEST(MeshTest, NormalsOfTheFileAreKeptAndMadeUnits) {
  const ScratchFolder folder;
  const TriangleMesh mesh = read_obj(obj_file(folder, "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 3 4\nf 1//1 2//1 3//1\n"));
  for (const Vector3d& normal : mesh.normals) {
    EXPECT_NEAR((normal - Vector3d(0, 0.6, 0.8)).norm(), 0, 1e-6);
  }
}

// A tent of two squares whose ridge is a seam of the coordinates.
TEST(MeshTest, ASeamOfCoordinatesHasOneNormal) {
  const ScratchFolder folder;
  const TriangleMesh mesh = read_obj(obj_file(folder,
                                              "v -1 0 0\nv 0 0 1\nv 0 1 1\nv -1 1 0\nv 1 0 0\nv 1 1 0\n"
                                              "vt 0 0\nvt 0.5 0\nvt 0.5 1\nvt 0 1\nvt 0.6 0\nvt 0.6 1\nvt 1 0\nvt 1 1\n"
                                              "f 1/1 2/2 3/3 4/4\nf 2/5 5/7 6/8 3/6\n"));
  ASSERT_EQ(mesh.vertices.size(), 8U);
  ASSERT_EQ(mesh.coordinates.size(), 8U);
  int on_the_ridge = 0;
  for (std::size_t i = 0; i < 8; ++i) {
    if (mesh.vertices[i].z() != 1) continue;
    ++on_the_ridge;
    EXPECT_NEAR((mesh.normals[i] - Vector3d(0, 0, 1)).norm(), 0, 1e-12);
    // Pictures count rows downwards.
    EXPECT_NEAR(mesh.coordinates[i].y(), -mesh.vertices[i].y(), 1e-6);
  }
  EXPECT_EQ(on_the_ridge, 4);
}

TEST(MeshTest, CoordinatesAreKeptWhereAllCornersHaveThem) {
  const ScratchFolder folder;
  EXPECT_TRUE(read_obj(obj_file(folder, "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nf 1/1 2/1 3/1\nf 1 2 4\n"))
                  .coordinates.empty());
  const TriangleMesh sphere = sphere_mesh(8);
  ASSERT_EQ(sphere.coordinates.size(), sphere.vertices.size());
  for (std::size_t i = 0; i < sphere.vertices.size(); ++i) {
    EXPECT_NEAR(std::cos(sphere.coordinates[i].y()), sphere.vertices[i].z(), 1e-12);
  }
}

TEST(MeshTest, TrianglesWithoutAreaAreLeftOut) {
  const ScratchFolder folder;
  const TriangleMesh mesh =
      read_obj(obj_file(folder, "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nf 1 2 3\nf 1 2 4\nf 1 1 2\n"));
  EXPECT_EQ(mesh.triangles.size(), 1U);
}

TEST(MeshTest, ThreeTrianglesOnOneEdgeAreFine) {
  const ScratchFolder folder;
  const TriangleMesh mesh =
      read_obj(obj_file(folder, "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nf 1 2 3\nf 2 1 4\nf 1 2 5\n"));
  EXPECT_EQ(mesh.triangles.size(), 3U);
}

struct BadMesh {
  std::string text, message;
};

class BadMeshTest : public testing::TestWithParam<BadMesh> {};

TEST_P(BadMeshTest, IsRefusedByName) {
  const ScratchFolder folder;
  try {
    read_obj(obj_file(folder, GetParam().text));
    FAIL() << GetParam().text;
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("mesh.obj"), testing::HasSubstr(GetParam().message)));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Files, BadMeshTest,
    testing::Values(BadMesh{"", "no triangle with an area"}, BadMesh{"not a mesh\n", "no triangle with an area"},
                    BadMesh{"v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "no triangle with an area"},
                    BadMesh{"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "refers to vertex 9; expected 1 to 3"},
                    BadMesh{"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 3 2 1\n", "face opposite ways"},
                    BadMesh{"v 0 0 0\nv 1e400 0 0\nv 0 1 0\nf 1 2 3\n", "finite numbers"}));

TEST(MeshTest, AFileThatIsNotThereIsNamed) { EXPECT_THROW(read_obj("/nowhere/at/all.obj"), std::invalid_argument); }

}  // namespace textonbench::mesh_test
