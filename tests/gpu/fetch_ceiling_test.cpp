#include "gpu/fetch_ceiling.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <stdexcept>

#include "gpu/renderer.h"

namespace textonbench::fetch_ceiling_test {

constexpr Extent texels{8, 4};
constexpr Extent pixels{64, 32};

/// Texel (x, y) of layer l is 32 l + 8 y + x.
ShaderRecipe numbered(double useful_fetches, int layers) {
  ShaderTexture texture;
  texture.sampler = "numbers";
  texture.size = texels;
  texture.layers = layers;
  texture.levels.emplace_back();
  for (int i = 0; i < layers * texels.width * texels.height; ++i) {
    texture.levels.front().push_back(static_cast<float>(i));
  }
  ShaderRecipe recipe;
  recipe.shader = "any";
  recipe.textures = {texture};
  recipe.words = {{"words", {1, 2}}};
  recipe.uniforms = {{"start", 1.0F}};
  recipe.useful_fetches = useful_fetches;
  return recipe;
}

TEST(FetchCeilingRecipeTest, KeepsTheTextureAndRoundsItsFetches) {
  const ShaderRecipe ceiling = fetch_ceiling_recipe(numbered(29.6, 2), true);
  EXPECT_EQ(ceiling.shader, "fetch_ceiling");
  EXPECT_EQ(ceiling.useful_fetches, 30);
  ASSERT_EQ(ceiling.textures.size(), 1U);
  EXPECT_EQ(ceiling.textures.front().levels.front().size(), 64U);
  EXPECT_TRUE(ceiling.uniforms.empty());
  EXPECT_TRUE(ceiling.words.empty());
  EXPECT_EQ(fetch_ceiling_recipe(numbered(0.1, 1), true).useful_fetches, 1);
}

TEST(FetchCeilingRecipeTest, NeedsATexture) {
  EXPECT_THROW(fetch_ceiling_recipe(ShaderRecipe(), true), std::invalid_argument);
}

class FetchCeilingTest : public testing::TestWithParam<ShaderPath> {
 protected:
  void SetUp() override {
    try {
      context_ = make_context();
    } catch (const GpuError& error) {
      GTEST_SKIP() << error.what();
    }
    if (GetParam() == ShaderPath::compute && !context_->info().compute()) GTEST_SKIP() << "no compute shaders";
  }
  Image draw(const ShaderRecipe& recipe) {
    Frame frame;
    frame.size = pixels;
    frame.origin = {-3, 5};
    return Renderer(*context_, recipe, GetParam()).draw(frame);
  }

  std::unique_ptr<Context> context_;
};

TEST_P(FetchCeilingTest, CoherentFetchesOfNeighborsAreNeighbors) {
  const Image image = draw(fetch_ceiling_recipe(numbered(1, 1), true));
  for (int y = 0; y < pixels.height; ++y) {
    for (int x = 0; x < pixels.width; ++x) {
      ASSERT_EQ(image.at(0, x, y), 8 * ((y + 5) % 4) + (x + 5) % 8) << x << ", " << y;
    }
  }
}

TEST_P(FetchCeilingTest, IncoherentFetchesAreSpreadOverTheTexture) {
  const Image image = draw(fetch_ceiling_recipe(numbered(1, 1), false));
  double mean = 0, square = 0, neighbors = 0;
  const auto n = static_cast<double>(pixels.area());
  for (int y = 0; y < pixels.height; ++y) {
    for (int x = 0; x < pixels.width; ++x) {
      const double v = image.at(0, x, y) - 15.5;
      mean += v / n;
      square += v * v / n;
      if (x > 0) neighbors += v * (image.at(0, x - 1, y) - 15.5) / n;
    }
  }
  // Of 32 equally probable numbers: variance 85.25, and 5 standard errors of each mean (false alarms below 1e-5).
  EXPECT_NEAR(mean, 0, 5 * std::sqrt(85.25 / n));
  EXPECT_NEAR(square, 85.25, 5 * 76.3 / std::sqrt(n));
  EXPECT_NEAR(neighbors, 0, 5 * 85.25 / std::sqrt(n));
}

TEST_P(FetchCeilingTest, LayersTakeTurns) {
  ShaderRecipe recipe = numbered(6, 3);
  for (float& v : recipe.textures.front().levels.front()) v = std::floor(v / 32);
  const Image image = draw(fetch_ceiling_recipe(recipe, false));
  for (int x = 0; x < pixels.width; ++x) ASSERT_NEAR(image.at(0, x, 7), 1, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Paths, FetchCeilingTest, testing::Values(ShaderPath::fragment, ShaderPath::compute),
                         [](const auto& path) { return path.param == ShaderPath::compute ? "Compute" : "Fragment"; });

}  // namespace textonbench::fetch_ceiling_test
