#include "experiments/frame_timing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <numeric>
#include <stdexcept>

#include "experiments/shader_models.h"

namespace textonbench::frame_timing_test {

TEST(FrameTimesTest, QuantilesAreInterpolated) {
  std::vector<double> times(101);
  std::iota(times.rbegin(), times.rend(), 2.0);  // 102 … 2
  const FrameTimes all = frame_times(times);
  EXPECT_DOUBLE_EQ(all.min, 2);
  EXPECT_DOUBLE_EQ(all.p05, 7);
  EXPECT_DOUBLE_EQ(all.median, 52);
  EXPECT_DOUBLE_EQ(all.p95, 97);
  EXPECT_DOUBLE_EQ(frame_times({3, 1}).median, 2);
  EXPECT_DOUBLE_EQ(frame_times({3, 1}).p95, 2.9);
  EXPECT_DOUBLE_EQ(frame_times({4}).p05, 4);
  EXPECT_THROW(frame_times({}), std::invalid_argument);
}

ShaderRecipe fetching_recipe() {
  ShaderTexture texture;
  texture.sampler = "texels";
  texture.size = {16, 16};
  texture.levels.emplace_back(256, 1.0F);
  ShaderRecipe recipe;
  recipe.shader = "plane_probe";
  recipe.channels = 8;
  recipe.textures = {texture};
  recipe.useful_fetches = 4;
  return recipe;
}

TEST(FrameTimingTest, RatesFollowFromTheMedian) {
  std::unique_ptr<Context> context;
  try {
    context = make_context();
  } catch (const GpuError& error) {
    GTEST_SKIP() << error.what();
  }
  FrameTimingOptions options;
  options.frame.size = {64, 32};
  options.frame.supersampling = 3;
  options.frames = 5;
  const FrameTiming timing = time_frames(*context, fetching_recipe(), options);
  EXPECT_EQ(timing.frames, 5);
  const FrameTimes& ms = timing.milliseconds;
  EXPECT_GT(ms.min, 0);
  EXPECT_LE(ms.min, ms.p05);
  EXPECT_LE(ms.p05, ms.median);
  EXPECT_LE(ms.median, ms.p95);
  EXPECT_DOUBLE_EQ(timing.frames_per_second, 1e3 / ms.median);
  EXPECT_DOUBLE_EQ(timing.ns_per_pixel, 1e6 * ms.median / 2048);
  EXPECT_DOUBLE_EQ(timing.useful_fetches_per_pixel, 36);
  EXPECT_DOUBLE_EQ(timing.fetches_per_second, 36 * 2048 / (1e-3 * ms.median));
  EXPECT_GT(timing.incoherent_ceiling.value(), 0);
  EXPECT_DOUBLE_EQ(timing.fetch_ceiling_fraction.value(), timing.fetches_per_second / timing.coherent_ceiling.value());

  // Pixels above the ground fetch nothing.
  options.frame.supersampling = 1;
  options.frame.ground = GroundViewOptions{.pitch = 0.2};
  const FrameTiming ground = time_frames(*context, fetching_recipe(), options);
  EXPECT_GT(ground.useful_fetches_per_pixel, 1);
  EXPECT_LT(ground.useful_fetches_per_pixel, 3.5);

  const nlohmann::ordered_json json = to_json(timing);
  EXPECT_EQ(json["path"], "fragment");
  EXPECT_EQ(json["ms"]["median"], ms.median);
  EXPECT_EQ(to_json(context->info())["software"], context->info().software);
}

TEST(ShaderModelsTest, AMethodWithoutAShaderIsToldWhichHaveOne) {
  Exemplar exemplar{.name = "noise", .pixels = Image({32, 32}, 1), .sha256 = ""};
  for (int y = 0; y < 32; ++y)
    fill_normal(Stream(Seed{2}), static_cast<std::uint64_t>(y), 0, exemplar.pixels.row(0, y));
  const MethodEntry& adsn = find_method("adsn");
  const std::unique_ptr<Model> model = adsn.analyze({exemplar}, Params(adsn.params, {}), Seed{1});
  try {
    shader_of(*model, "adsn", {.seed = Seed{1}});
    FAIL() << "adsn has a shader";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("adsn has no shader"));
    EXPECT_THAT(error.what(), testing::HasSubstr("texton_noise"));
  }
}

}  // namespace textonbench::frame_timing_test
