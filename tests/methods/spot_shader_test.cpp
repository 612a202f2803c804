#include "methods/spot/spot_shader.h"

#include <gmock/gmock.h>

#include "tests/texton.h"

namespace textonbench::spot_shader_test {

using testing::HasSubstr;

void expect_refusal(const Texton& texton, const SpotNoiseOptions& options, const ShaderRequest& request,
                    const std::string& reason) {
  try {
    make_spot_noise(texton, options)->shader(request);
    ADD_FAILURE() << "served in spite of: " << reason;
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr(reason));
  }
}

TEST(SpotShader, RefusesWhatAShaderCannotDo) {
  const Texton texton = test_texton({9, 7}, 1, 1);
  expect_refusal(texton, {.mni = 63 * 4.5}, {}, "drawn pixel by pixel");
  expect_refusal(texton, {.mni = 5}, {.filter = ShaderFilter::trilinear}, "expected filter none");
  expect_refusal(texton, {.mni = 5}, {.near = {0x1p41, 0}}, "within 2^40");
  expect_refusal(texton, {.impacts = Impacts::stratified, .mni = 1e-10}, {}, "at most 2^18");
  expect_refusal(texton, {.impacts = Impacts::gaussian}, {}, "expected impacts = poisson or stratified");
}

TEST(SpotShader, FetchesAreTheImpactsThatCoverAPixel) {
  for (const Impacts impacts : {Impacts::poisson, Impacts::stratified}) {
    const ShaderRecipe recipe =
        make_spot_noise(test_texton({9, 7}, 6, 1), {.impacts = impacts, .mni = 12})->shader({}).value();
    EXPECT_NEAR(recipe.useful_fetches, 24, 0.1);
    EXPECT_TRUE(recipe.on_grid);
    EXPECT_EQ(recipe.channels, 6);
  }
}

}  // namespace textonbench::spot_shader_test
