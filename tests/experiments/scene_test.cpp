#include "experiments/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>

#include "tests/temporary_folder.h"

namespace textonbench::scene_test {

using testing::HasSubstr;

ShaderRecipe recipe_with_torus() {
  ShaderRecipe recipe;
  recipe.mesh = std::make_shared<const TriangleMesh>(torus_mesh(0.5, 8));
  recipe.tilt = 0.25;
  return recipe;
}

void expect_scene_refused(const std::function<void()>& act, const std::string& expected) {
  try {
    act();
    FAIL() << expected;
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr(expected));
  }
}

TEST(SceneTest, ThePlaneIsTheWindow) {
  const Frame frame =
      scene_frame({.supersampling = 3}, {.size = {20, 10}, .origin = {4, -5}, .step = 0.5}, ShaderRecipe{});
  EXPECT_EQ(frame.size, (Extent{20, 10}));
  EXPECT_EQ(frame.origin, Eigen::Vector2d(4, -5));
  EXPECT_EQ(frame.step, 0.5);
  EXPECT_EQ(frame.supersampling, 3);
  EXPECT_FALSE(frame.ground || frame.surface);
  EXPECT_FALSE(surface_scene({}, ShaderRecipe{}));
}

TEST(SceneTest, AnglesAreDegrees) {
  const Frame ground = scene_frame({.scene = "ground", .pitch = 90, .field = 45}, {.size = {2, 2}}, ShaderRecipe{});
  EXPECT_DOUBLE_EQ(ground.ground->pitch, std::numbers::pi / 2);
  EXPECT_DOUBLE_EQ(ground.ground->field, std::numbers::pi / 4);
  const Frame sphere = scene_frame({.scene = "sphere", .azimuth = 180}, {.size = {2, 2}}, ShaderRecipe{});
  EXPECT_DOUBLE_EQ(sphere.surface->tilt, 35 * std::numbers::pi / 180);
  EXPECT_DOUBLE_EQ(sphere.surface->azimuth, std::numbers::pi);
}

TEST(SceneTest, ADisplacedSurfaceIsAsBumpy) {
  const SceneOptions options{.scene = "torus", .displacement = 7};
  const auto scene = surface_scene(options, ShaderRecipe{});
  ASSERT_TRUE(scene);
  EXPECT_TRUE(scene->bumpy);
  EXPECT_TRUE(scene->displaced);
  EXPECT_EQ(scene_frame(options, {.size = {2, 2}}, ShaderRecipe{}).surface->bump, 7);
}

TEST(SceneTest, AModelOnASurfaceIsShownThere) {
  const ShaderRecipe recipe = recipe_with_torus();
  EXPECT_EQ(surface_scene({.bump = 1}, recipe)->mesh, recipe.mesh);
  EXPECT_DOUBLE_EQ(scene_frame({}, {.size = {2, 2}}, recipe).surface->tilt, 0.25);
  EXPECT_DOUBLE_EQ(scene_frame({.tilt = 90}, {.size = {2, 2}}, recipe).surface->tilt, std::numbers::pi / 2);
  expect_scene_refused([&] { surface_scene({.scene = "sphere"}, recipe); }, "surface of its own");
}

TEST(SceneTest, WhatIsNoSceneIsTold) {
  expect_scene_refused([] { surface_scene({.scene = "teapot"}, ShaderRecipe{}); },
                       "scene teapot: no such file; expected plane, ground, sphere, torus or a Wavefront OBJ file");
  expect_scene_refused([] { surface_scene({.bump = 2}, ShaderRecipe{}); }, "on the scene plane: expected a surface");
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "bad.obj") << "v 0 0 0\nf 1 2 3\n";
  expect_scene_refused([&] { surface_scene({.scene = (folder.path() / "bad.obj").string()}, ShaderRecipe{}); },
                       "bad.obj: a face refers to vertex 2; expected 1 to 1");
}

}  // namespace textonbench::scene_test
