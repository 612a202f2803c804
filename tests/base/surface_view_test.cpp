#include "methods/base/surface_view.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace textonbench::surface_view_test {

using Eigen::Vector3d;

TEST(SurfaceViewTest, AFrameIsOrthonormalAndRightHanded) {
  for (const Vector3d& direction : {Vector3d(1, 2, 3), Vector3d(-1, 0, 0), Vector3d(0, 0, 1), Vector3d(0, 0, -1)}) {
    const Vector3d normal = direction.normalized();
    const SurfacePoint point = surface_point(Vector3d::Zero(), normal);
    EXPECT_NEAR(point.u1.norm(), 1, 1e-12);
    EXPECT_NEAR(point.u1.dot(point.normal), 0, 1e-12);
    EXPECT_NEAR((point.u1.cross(point.u2) - normal).norm(), 0, 1e-12);
  }
}

TEST(SurfaceViewTest, ASphereIsADiscOfItsNearHalf) {
  const double tilt = 0.4;
  const double radius = 60;
  const auto points = view_mesh(sphere_mesh(200), {151, 131}, radius, tilt);
  EXPECT_NEAR(static_cast<double>(points.size()), std::numbers::pi * radius * radius, 60);
  const Vector3d sight(std::cos(tilt), 0, std::sin(tilt));
  for (const ViewedPoint& seen : points) {
    EXPECT_NEAR(seen.point.position.norm(), radius, 0.02);
    EXPECT_GT(seen.point.position.dot(sight), -1e-6);
    EXPECT_NEAR((seen.point.normal - seen.point.position / radius).norm(), 0, 1e-3);
    // The z axis goes up in the picture, and the picture's plane keeps lengths.
    EXPECT_NEAR(seen.x - 75, seen.point.position.y(), 1e-9);
    EXPECT_NEAR(65 - seen.y, seen.point.position.dot(Vector3d(-std::sin(tilt), 0, std::cos(tilt))), 1e-9);
  }
}

TEST(SurfaceViewTest, TheNearestOfTwoSheetsIsSeen) {
  TriangleMesh mesh;
  for (const double x : {-1.0, 1.0}) {
    for (const auto& [y, z] : {std::pair{-1.0, -1.0}, {1.0, -1.0}, {0.0, 1.0}}) {
      mesh.vertices.emplace_back(x, y, z);
      mesh.normals.emplace_back(-1, 0, 0);
    }
  }
  mesh.triangles = {{3, 4, 5}, {0, 1, 2}};
  const auto points = view_mesh(mesh, {41, 41}, 20, 0);
  ASSERT_FALSE(points.empty());
  for (const ViewedPoint& seen : points) {
    EXPECT_GT(seen.point.position.x(), 0);
    EXPECT_NEAR(seen.facing, 1, 1e-12);  // the back side shows too
  }
}

TEST(SurfaceViewTest, TheTorusHasAHole) {
  const auto points = view_mesh(torus_mesh(0.3, 60), {101, 101}, 50, std::numbers::pi / 2);
  for (const ViewedPoint& seen : points) {
    const double distance = std::hypot(seen.x - 50, seen.y - 50);
    EXPECT_GT(distance, 50 * 0.7 / 1.3 - 1);
    EXPECT_LT(distance, 51);
  }
}

}  // namespace textonbench::surface_view_test
