#include "methods/base/ground_view.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace textonbench::ground_view_test {

constexpr Extent picture{160, 120};

/// The ray of a pinhole camera met with the plane, by rotation matrices.
TEST(GroundView, ShowsWhereTheRayOfAPixelMeetsTheGround) {
  const GroundViewOptions options{.height = 10, .pitch = 0.5, .field = 1.2};
  const GroundView view(picture, options);
  const double focal = 80 / std::tan(0.6);
  for (const auto& [x, y] : {std::pair{79.5, 59.5}, {3.0, 100.0}, {150.0, 40.0}, {20.25, 118.0}}) {
    // Before it is tilted the camera looks along the first axis, its second axis to the right, its third down.
    const Eigen::Vector3d ray(focal, x - 79.5, y - 59.5);
    const Eigen::Vector3d tilted = Eigen::AngleAxisd(-options.pitch, Eigen::Vector3d::UnitY()) * ray;
    ASSERT_GT(tilted.z(), 0);
    const Eigen::Vector3d met = options.height / tilted.z() * tilted;
    const Eigen::Vector2d point = view.point(x, y);
    EXPECT_NEAR(point.x(), met.y(), 1e-10);
    EXPECT_NEAR(point.y(), -met.x(), 1e-10);
  }
}

TEST(GroundView, FootprintsAreDerivatives) {
  const GroundView view(picture, {.height = 30, .pitch = 0.3, .field = 1});
  constexpr double step = 1e-4;
  for (const auto& [x, y] : {std::pair{79.5, 59.5}, {3.0, 100.0}, {150.0, 50.0}}) {
    const Eigen::Matrix2d footprint = view.footprint(x, y);
    const Eigen::Vector2d right = (view.point(x + step, y) - view.point(x - step, y)) / (2 * step);
    const Eigen::Vector2d down = (view.point(x, y + step) - view.point(x, y - step)) / (2 * step);
    EXPECT_LT((footprint.col(0) - right).norm(), 1e-5 * right.norm());
    EXPECT_LT((footprint.col(1) - down).norm(), 1e-5 * down.norm());
  }
}

TEST(GroundView, TheGroundEndsWherePixelsBecomeTooLong) {
  const GroundView view(picture, {.height = 30, .pitch = 0.3, .field = 1, .furthest = 20});
  int covered = 0;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      if (view.covers(x, y)) {
        ++covered;
        EXPECT_LE(view.footprint(x, y).colwise().norm().maxCoeff(), 20);
        EXPECT_LT(view.point(x, y - 0.5).y(), 0) << "no part of a pixel is beyond the horizon";
      }
    }
  }
  EXPECT_TRUE(view.covers(0, picture.height - 1));
  EXPECT_FALSE(view.covers(0, 0));
  EXPECT_GT(covered, picture.area() / 2);
  EXPECT_LT(covered, picture.area());
}

TEST(GroundView, OptionsOutOfRangeAreNamed) {
  const auto message = [](const GroundViewOptions& options) {
    try {
      const GroundView view(picture, options);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(message({.height = 0}), testing::HasSubstr("height = 0"));
  EXPECT_THAT(message({.pitch = 2}), testing::HasSubstr("pitch = 2"));
  EXPECT_THAT(message({.field = std::nan("")}), testing::HasSubstr("field = nan"));
  EXPECT_THAT(message({.furthest = -1}), testing::HasSubstr("furthest = -1"));
  EXPECT_EQ(message({}), "");
}

}  // namespace textonbench::ground_view_test
