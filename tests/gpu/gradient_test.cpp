// Gradients of the shaders are the derivatives of what they draw.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "methods/method.h"
#include "methods/spot/surface_shader.h"
#include "tests/gpu/texton_shader.h"
#include "tests/texture.h"

namespace textonbench::gradient_test {

constexpr Seed seed{12};
constexpr Extent size{29, 23};

class GradientTest : public testing::TestWithParam<ShaderPath> {
 protected:
  void SetUp() override {
    std::string reason;
    context_ = test_context(ContextKind::egl, reason);
    if (!context_) GTEST_SKIP() << reason;
    if (GetParam() == ShaderPath::compute && !context_->info().compute()) GTEST_SKIP() << "no compute shaders";
  }

  Image draw(ShaderRecipe recipe, int derivative, const Eigen::Vector2d& origin, double step) {
    recipe.derivative = derivative;
    return Renderer(*context_, recipe, GetParam()).draw({.size = size, .origin = origin, .step = step});
  }

  /// Largest difference between the derivative by an axis and the quotient of differences over ±h, in root mean squares
  /// of the derivative; pixels beyond `spared` of them, where the field or its derivative jumps, are left out.
  double difference(const ShaderRecipe& recipe, int axis, double spared, double h) {
    const Eigen::Vector2d origin(-3.3, 7.1);
    constexpr double step = 0.37;
    Eigen::Vector2d shift(0, 0);
    shift[axis] = h;
    const Image slope = draw(recipe, axis, origin, step);
    const Image after = draw(recipe, -1, origin + shift, step), before = draw(recipe, -1, origin - shift, step);
    double squares = 0;
    std::vector<double> differences;
    for (int c = 0; c < slope.channels(); ++c) {
      for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
          squares += std::pow(slope.at(c, x, y), 2);
          differences.push_back(std::abs((after.at(c, x, y) - before.at(c, x, y)) / (2 * h) - slope.at(c, x, y)));
        }
      }
    }
    std::ranges::sort(differences);
    const auto last = static_cast<std::size_t>((1 - spared) * static_cast<double>(differences.size() - 1));
    return differences[last] / std::sqrt(squares / static_cast<double>(differences.size()));
  }

  /// Of a method fitted to a small texture.
  ShaderRecipe recipe_of(const char* name, const std::map<std::string, ParamValue>& given, ShaderFetch fetch) {
    const MethodEntry& method = find_method(name);
    const Exemplar exemplar{.name = "smooth", .pixels = test_texture({64, 48}, 3), .sha256 = ""};
    const Params params(method.params, given);
    const auto model = method.analyze({.exemplar = exemplar}, params, seed);
    return model->shader({.seed = seed, .fetch = fetch}).value();
  }

  /// Both axes.
  void expect_below(const ShaderRecipe& recipe, double tolerance, double spared = 0, double h = 1.0 / 64) {
    for (const int axis : {0, 1}) EXPECT_LT(difference(recipe, axis, spared, h), tolerance) << "axis " << axis;
  }

  std::unique_ptr<Context> context_;
};

// Differences over 1/32 pixel of values near 1 to float32's rounding leave 1e-5; their third derivatives, of waves of
// at most half a cycle a pixel, (π h)² / 6 = 4e-4.
constexpr double smooth = 5e-3;

TEST_P(GradientTest, TextonNoiseOfSplines) {
  const auto noise = [&](std::int64_t order) {
    return recipe_of("texton_noise", {{"order", order}, {"support", std::int64_t{9}}}, ShaderFetch::manual);
  };
  expect_below(noise(3), smooth);
  // Its second derivatives jump, by J at most: that makes h J / 4.
  expect_below(noise(2), 0.05);
  // A piecewise bilinear field, whose derivatives jump where two of its pieces meet: within h of a pixel in thirty a
  // piece and impact.
  expect_below(noise(1), smooth, 0.5);
}

TEST_P(GradientTest, SurfaceNoise) {
  expect_below(recipe_of("surface_noise",
                         {{"order", std::int64_t{3}}, {"support", std::int64_t{9}}, {"surface", std::string("plane")}},
                         ShaderFetch::manual),
               smooth);
}

TEST_P(GradientTest, LocalRandomPhase) {
  expect_below(recipe_of("lrp", {{"cosines", std::int64_t{12}}}, ShaderFetch::hardware), smooth);
  expect_below(
      recipe_of("lrp", {{"cosines", std::int64_t{12}}, {"variance", std::string("lattice")}}, ShaderFetch::hardware),
      smooth);
}

TEST_P(GradientTest, StructureWithTurbulenceAndPlacement) {
  for (const char* reduction : {"none", "blocks"}) {
    SCOPED_TRACE(reduction);
    std::map<std::string, ParamValue> given{
        {"cosines", std::int64_t{12}}, {"structure", 0.5}, {"reduction", std::string(reduction)}};
    expect_below(recipe_of("lrp", given, ShaderFetch::hardware), smooth);
    given["placement"] = std::string("random");
    expect_below(recipe_of("lrp", given, ShaderFetch::hardware), smooth);
    // The gradient of |n| jumps where n is 0, within h of one in a hundred pixels a layer.
    given["turbulence"] = 2.0;
    expect_below(recipe_of("lrp", given, ShaderFetch::hardware), 0.02, 0.1, 1.0 / 256);
  }
}

TEST_P(GradientTest, GaborNoise) {
  // Kernels are cut where 2e-2 of their height is left: their jumps are spared.
  expect_below(recipe_of("gabor", {{"frequency", 0.1}, {"bandwidth", 0.05}, {"cut", 1e-4}}, ShaderFetch::hardware),
               smooth, 0.05);
  expect_below(recipe_of("gabor", {{"frequency", 0.1}, {"bandwidth", 0.05}, {"cut", 1e-4}, {"footprint", 2.0}},
                         ShaderFetch::hardware),
               smooth, 0.05);
}

TEST_P(GradientTest, WhatHasNoneSaysSo) {
  const ShaderRecipe steps =
      recipe_of("texton_noise", {{"order", std::int64_t{0}}, {"support", std::int64_t{9}}}, ShaderFetch::manual);
  EXPECT_THROW(draw(steps, 0, {0, 0}, 1), std::invalid_argument);
}

INSTANTIATE_TEST_SUITE_P(Paths, GradientTest, testing::Values(ShaderPath::fragment, ShaderPath::compute),
                         [](const auto& tested) {
                           return tested.param == ShaderPath::compute ? "compute" : "fragment";
                         });

}  // namespace textonbench::gradient_test
