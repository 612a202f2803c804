#include "methods/spot/spline_shader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "methods/spot/spline_scale.h"
#include "methods/spot/texton_filter.h"
#include "tests/texton.h"

namespace textonbench::spline_shader_test {

using testing::HasSubstr;
using testing::Pair;

SplineTexton spline_texton(int order, int channels, int kernels, Extent extent = {9, 7}) {
  SplineTexton texton{.coefficients = test_texton(extent, channels, kernels), .order = order};
  texton.support_area = (extent.width + order) * (extent.height + order);
  return texton;
}

const ShaderValue& uniform(const ShaderRecipe& recipe, const std::string& name) {
  const auto found = std::ranges::find(recipe.uniforms, name, &std::pair<std::string, ShaderValue>::first);
  if (found == recipe.uniforms.end()) throw std::out_of_range(name);
  return found->second;
}

TEST(SplineShader, TexelsAreScaledCoefficientsByKernelsAndGroupsOfChannels) {
  const SplineTexton texton = spline_texton(3, 6, 2);
  const SplineNoiseOptions options{.impacts = ImpactProcess::poisson, .mni = 20};
  const ShaderRecipe recipe = spline_noise_recipe(texton, options, {});
  const double scale = spline_noise_scale(texton, options, spline_noise_impacts(texton, options));
  ASSERT_EQ(recipe.textures.size(), 1U);
  const ShaderTexture& texture = recipe.textures.front();
  EXPECT_EQ(recipe.channels, 6);
  EXPECT_EQ(texture.size, (Extent{9, 7}));
  EXPECT_EQ(texture.layers, 4);
  EXPECT_EQ(texture.components, 4);
  ASSERT_EQ(texture.levels.size(), 1U);
  for (int layer = 0; layer < 4; ++layer) {
    for (int i = 0; i < 9 * 7; ++i) {
      for (int c = 0; c < 4; ++c) {
        const int channel = layer % 2 * 4 + c;
        const Image& kernel = texton.coefficients.kernels[static_cast<std::size_t>(layer / 2)];
        const double expected = channel < 6 ? scale * static_cast<double>(kernel.at(channel, i % 9, i / 9)) : 0;
        EXPECT_EQ(texture.levels[0][static_cast<std::size_t>((layer * 63 + i) * 4 + c)], static_cast<float>(expected));
      }
    }
  }
}

TEST(SplineShader, MipLevelsAreThoseOfTheMipChain) {
  const SplineTexton texton = spline_texton(1, 3, 2, {11, 6});
  const SplineNoiseOptions options{.impacts = ImpactProcess::stratified, .mni = 5};
  const ShaderRecipe recipe = spline_noise_recipe(texton, options, {.filter = ShaderFilter::trilinear});
  const double scale = spline_noise_scale(texton, options, spline_noise_impacts(texton, options));
  const ShaderTexture& texture = recipe.textures.front();
  EXPECT_EQ(texture.size, (Extent{16, 16}));
  for (int k = 0; k < 2; ++k) {
    const MipChain chain(texton.coefficients.kernels[static_cast<std::size_t>(k)]);
    ASSERT_EQ(texture.levels.size(), static_cast<std::size_t>(chain.coarsest() + 1));
    for (int l = 0; l <= chain.coarsest(); ++l) {
      const int side = 16 >> l;
      const Extent kept = chain.extent(l);
      const std::vector<float>& texels = texture.levels[static_cast<std::size_t>(l)];
      auto next = texels.cbegin() + std::ptrdiff_t{4} * k * side * side;
      for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
          const Texel expected = x < kept.width && y < kept.height ? chain.texel(l, x, y) : Texel::Zero();
          for (int c = 0; c < 4; ++c) EXPECT_NEAR(*next++, scale * static_cast<double>(expected[c]), 1e-6);
        }
      }
    }
  }
}

TEST(SplineShader, BaseIsTheCornerOfTheCellOfThePlace) {
  const SplineTexton texton = spline_texton(1, 1, 1);
  const SplineNoiseOptions options{.impacts = ImpactProcess::stratified, .mni = 5};
  const ImpactGrid grid = spline_noise_impacts(texton, options);
  const ShaderRecipe recipe = spline_noise_recipe(texton, options, {.near = {-1, 0x1p40}});
  EXPECT_EQ(recipe.base.x(), -grid.side());
  EXPECT_LE(recipe.base.y(), 0x1p40);
  EXPECT_GT(recipe.base.y(), 0x1p40 - grid.side());
  const auto cell = std::get<std::array<std::uint32_t, 4>>(uniform(recipe, "base_cell"));
  EXPECT_EQ(cell[0], 0xFFFFFFFFU);
  EXPECT_EQ(cell[1], 0xFFFFFFFFU);
  EXPECT_EQ(static_cast<double>(std::uint64_t{cell[3]} << 32U | cell[2]) * grid.side(), recipe.base.y());
  EXPECT_EQ(std::get<std::int32_t>(uniform(recipe, "cell_side")), grid.coarse_side());
}

TEST(SplineShader, UsefulFetchesAreTheImpactsThatCoverAPixel) {
  const SplineNoiseOptions options{.impacts = ImpactProcess::poisson, .mni = 20};
  const auto fetches = [&](int order, int channels, ShaderFetch fetch) {
    return spline_noise_recipe(spline_texton(order, channels, 1), options, {.fetch = fetch}).useful_fetches;
  };
  EXPECT_NEAR(fetches(0, 3, ShaderFetch::hardware), 20, 1e-9);
  EXPECT_NEAR(fetches(1, 3, ShaderFetch::hardware), 20, 1e-9);
  EXPECT_NEAR(fetches(1, 8, ShaderFetch::hardware), 40, 1e-9);
  EXPECT_NEAR(fetches(3, 3, ShaderFetch::hardware), 80, 1e-9);
  EXPECT_NEAR(fetches(3, 3, ShaderFetch::manual), 320, 1e-9);
  EXPECT_NEAR(spline_noise_recipe(spline_texton(1, 3, 1), options,
                                  {.fetch = ShaderFetch::manual, .filter = ShaderFilter::trilinear})
                  .useful_fetches,
              20, 1e-9);
}

TEST(SplineShader, ThresholdsThatAreAllOneAreNoBufferOfNothing) {
  // The probability of an impact in a cell is below the rounding of 1.
  const ShaderRecipe recipe = spline_noise_recipe(spline_texton(0, 1, 1, {1, 1}),
                                                  {.impacts = ImpactProcess::poisson, .mni = 1e-12, .cell = 0.01}, {});
  ASSERT_EQ(recipe.words.size(), 1U);
  EXPECT_EQ(recipe.words.front().words.size(), 1U);
  EXPECT_THAT(recipe.defines, testing::Contains(Pair("THRESHOLDS", "0")));
}

void expect_refusal(const SplineTexton& texton, const SplineNoiseOptions& options, const ShaderRequest& request,
                    const std::string& reason) {
  try {
    make_spline_noise(texton, options)->shader(request);
    ADD_FAILURE() << "served in spite of: " << reason;
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr(reason));
  }
}

TEST(SplineShader, RefusesWhatAShaderCannotDo) {
  const SplineNoiseOptions stratified{.impacts = ImpactProcess::stratified, .mni = 5};
  for (const int order : {2, 4, 5}) {
    expect_refusal(spline_texton(order, 1, 1), stratified, {}, "manual fetches");
  }
  expect_refusal(spline_texton(3, 1, 1), stratified, {.filter = ShaderFilter::mipmap}, "expected order 1");
  expect_refusal(spline_texton(1, 1, 1), stratified, {.near = {0x1p41, 0}}, "within 2^40");
  expect_refusal(spline_texton(1, 1, 1), {.impacts = ImpactProcess::stratified, .mni = 1e-10}, {}, "at most 2^18");
}

}  // namespace textonbench::spline_shader_test
