#include "gpu/renderer.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "gpu/shader_source.h"
#include "tests/gpu/texton_shader.h"

namespace textonbench::renderer_test {

using testing::HasSubstr;

ShaderRecipe plane_probe() {
  ShaderRecipe recipe;
  recipe.shader = "plane_probe";
  recipe.channels = 8;
  return recipe;
}

class RendererTest : public testing::TestWithParam<ShaderPath> {
 protected:
  void SetUp() override {
    try {
      context_ = make_context();
    } catch (const GpuError& error) {
      GTEST_SKIP() << error.what();
    }
    if (GetParam() == ShaderPath::compute && !context_->info().compute()) GTEST_SKIP() << "no compute shaders";
  }
  void TearDown() override {
    if (context_) {
      EXPECT_NO_THROW(context_->check("leaving a test"));
    }
  }
  Image draw(const Frame& frame, const ShaderRecipe& recipe) {
    return Renderer(*context_, recipe, GetParam()).draw(frame);
  }

  std::unique_ptr<Context> context_;
};

/// What the processor makes of a point: 2^−22 pixel, rounded down.
double fixed(double pixels) { return std::floor(pixels * 0x1p22); }

TEST_P(RendererTest, RasterIsExactInFixedPoint) {
  ShaderRecipe recipe = plane_probe();
  recipe.base = {-3.5, 0x1p33};
  for (const double step : {1.0, 0.25, 0.37, 3.0}) {
    SCOPED_TRACE(step);
    const Frame frame{.size = {37, 21}, .origin = {-20.125, 0x1p33 - 7.3}, .step = step};
    const Image image = draw(frame, recipe);
    for (int y = 0; y < 21; ++y) {
      for (int x = 0; x < 37; ++x) {
        const double px = fixed(frame.origin.x() + step * x - recipe.base.x());
        const double py = fixed(frame.origin.y() + step * y - recipe.base.y());
        // Steps that are no multiples of 2^−42 may round otherwise than in floating point.
        const double tolerance = step == 0.37 ? 1 : 0;
        ASSERT_NEAR(image.at(0, x, y) * 4096.0 + image.at(2, x, y), px, tolerance) << x << ", " << y;
        ASSERT_NEAR(image.at(1, x, y) * 4096.0 + image.at(3, x, y), py, 4096 * 0x1p-7 + tolerance) << x << ", " << y;
        ASSERT_FLOAT_EQ(image.at(4, x, y), static_cast<float>(step));
        ASSERT_EQ(image.at(5, x, y), 0);
      }
    }
  }
}

TEST_P(RendererTest, SamplesAverageAroundThePixel) {
  const Frame frame{.size = {5, 4}, .origin = {2, 3}, .step = 2, .supersampling = 4};
  const Image image = draw(frame, plane_probe());
  // The mean of coarse and fine coordinates is that of the points.
  EXPECT_NEAR(image.at(0, 1, 2) / 1024 + image.at(2, 1, 2) * 0x1p-22, 2 + 2 * 1, 1e-5);
  EXPECT_NEAR(image.at(1, 1, 2) / 1024 + image.at(3, 1, 2) * 0x1p-22, 3 + 2 * 2, 1e-5);
  EXPECT_FLOAT_EQ(image.at(4, 1, 2), 0.5F);
}

// All samples of a pixel at once would be more than 65535 turns of loops, where Mesa's software stops.
TEST_P(RendererTest, ManySamplesOfManyImpactsAverageAsPixelsOfAFinerFrameDo) {
  const SplineTexton texton = shader_texton(1, 3, 1);
  const auto noise = make_spline_noise(texton, {.impacts = ImpactProcess::poisson, .mni = 100});
  const ShaderRecipe recipe = noise->shader({.seed = Seed{3}, .fetch = ShaderFetch::manual}).value();
  constexpr int n = 20;
  const Frame frame{.size = {6, 5}, .origin = {4, 7}, .step = 2, .supersampling = n};
  const Frame fine{.size = {6 * n, 5 * n}, .origin = {4 + 1.0 / n - 1, 7 + 1.0 / n - 1}, .step = 2.0 / n};
  const Image averaged = draw(frame, recipe), samples = draw(fine, recipe);
  const std::vector<double> scale = deviations(texton);
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < 5; ++y) {
      for (int x = 0; x < 6; ++x) {
        double sum = 0;
        for (int j = 0; j < n; ++j) {
          for (int i = 0; i < n; ++i) sum += samples.at(c, n * x + i, n * y + j);
        }
        ASSERT_NEAR(averaged.at(c, x, y), sum / (n * n), 1e-5 * scale[static_cast<std::size_t>(c)]) << x << ", " << y;
      }
    }
  }
}

TEST_P(RendererTest, SoftwareRefusesMoreImpactsThanItsLoopsCount) {
  if (!context_->info().software) GTEST_SKIP() << "a graphics processor counts on";
  const auto noise = make_spline_noise(shader_texton(1, 1, 1), {.impacts = ImpactProcess::poisson, .mni = 5000});
  try {
    draw({.size = {4, 4}, .supersampling = 4}, noise->shader({.seed = Seed{3}}).value());
    FAIL() << "expected an error";
  } catch (const GpuError& error) {
    EXPECT_THAT(error.what(), HasSubstr("take fewer impacts"));
  }
}

TEST_P(RendererTest, GroundIsThatOfTheProcessor) {
  Frame frame{.size = {64, 48}, .origin = {10.5, -3.25}, .ground = GroundViewOptions{.height = 30, .pitch = 0.3}};
  const Image image = draw(frame, plane_probe());
  const GroundView view(frame.size, *frame.ground);
  int covered = 0;
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) {
      if (!view.covers(x, y)) {
        ASSERT_EQ(image.at(4, x, y), 0) << x << ", " << y;
        continue;
      }
      ++covered;
      const Eigen::Vector2d point = frame.origin + view.point(x, y);
      const Eigen::Matrix2d footprint = view.footprint(x, y);
      const double tolerance = 1e-6 * point.norm() + 1e-5;
      ASSERT_GE(image.at(2, x, y), 0);
      ASSERT_NEAR(image.at(0, x, y) / 1024 + image.at(2, x, y) * 0x1p-22, point.x(), tolerance) << x << ", " << y;
      ASSERT_NEAR(image.at(1, x, y) / 1024 + image.at(3, x, y) * 0x1p-22, point.y(), tolerance) << x << ", " << y;
      ASSERT_NEAR(image.at(4, x, y), footprint(0, 0), 1e-5 * footprint(0, 0));
      ASSERT_NEAR(image.at(6, x, y), footprint(0, 1), 1e-5 * footprint(1, 1));
      ASSERT_NEAR(image.at(7, x, y), footprint(1, 1), 1e-5 * footprint(1, 1));
    }
  }
  EXPECT_GT(covered, 1000);
  EXPECT_LT(covered, 64 * 48);
}

TEST_P(RendererTest, APixelOfTheGroundIsCoveredWithAllItsSamples) {
  const Frame frame{.size = {64, 48}, .ground = GroundViewOptions{.height = 30, .pitch = 0.3}, .supersampling = 4};
  const Image image = draw(frame, plane_probe());
  const GroundView view(frame.size, *frame.ground);
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) {
      const double expected = view.covers(x, y) ? view.footprint(x, y)(0, 0) / 4 : 0;
      // The mean over the pixel of a side that is inversely proportional to the depth.
      ASSERT_NEAR(image.at(4, x, y), expected, 0.1 * expected) << x << ", " << y;
    }
  }
}

TEST_P(RendererTest, FramesOfOtherSizesFollowEachOther) {
  Renderer renderer(*context_, plane_probe(), GetParam());
  EXPECT_EQ(renderer.draw({.size = {17, 5}}).extent(), (Extent{17, 5}));
  const Image larger = renderer.draw({.size = {40, 33}});
  EXPECT_EQ(larger.at(0, 39, 32), 39 * 1024);
  EXPECT_EQ(larger.at(1, 39, 32), 32 * 1024);
}

TEST_P(RendererTest, TimesAreOfEachFrame) {
  const std::vector<double> times = Renderer(*context_, plane_probe(), GetParam()).time({.size = {64, 64}}, 2, 5);
  ASSERT_EQ(times.size(), 5U);
  for (const double t : times) {
    EXPECT_GT(t, 0);
    EXPECT_LT(t, 1e4);
  }
}

/// The number of the first line of a file that has that word, from 1.
int line_of(const std::string& word, const std::string& file) {
  const std::string& text = shader_files().at(file);
  return 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<long>(text.find(word)), '\n'));
}

/// Of the file that is compiled, also below its includes, of those that it includes, and of the recipe's.
TEST_P(RendererTest, ALogNamesTheFileAndItsLine) {
  const std::string stage = GetParam() == ShaderPath::compute ? "compute" : "fragment";
  const std::vector<std::pair<std::string, std::string>> words{
      {"is_inside =", "plane_probe.glsl"}, {"share =", stage + ".glsl"}, {"depth =", "frame.glsl"}};
  for (const auto& [word, file] : words) {
    ShaderRecipe recipe = plane_probe();
    recipe.defines = {{word.substr(0, word.find(' ')), "1 +"}};
    try {
      draw({.size = {8, 8}}, recipe);
      FAIL() << "compiled";
    } catch (const GpuError& error) {
      EXPECT_THAT(error.what(), HasSubstr("the " + stage + " shader does not compile"));
      EXPECT_THAT(error.what(), HasSubstr(fmt::format("{}:{}", file, line_of(word, file))));
    }
  }
}

TEST_P(RendererTest, UnusableRecipesAndFramesAreRefusedWithTheReason) {
  const auto message = [this](const Frame& frame, const ShaderRecipe& recipe) -> std::string {
    try {
      draw(frame, recipe);
    } catch (const std::exception& error) {
      return error.what();
    }
    return "drawn";
  };
  const Frame frame{.size = {8, 8}};
  ShaderRecipe recipe = plane_probe();
  recipe.channels = 9;
  EXPECT_THAT(message(frame, recipe), HasSubstr("1 to 8"));
  recipe = plane_probe();
  recipe.shader = "no_such";
  EXPECT_THAT(message(frame, recipe), HasSubstr("no_such.glsl"));
  EXPECT_THAT(message({.size = {0, 8}}, plane_probe()), HasSubstr("0x8"));
  EXPECT_THAT(message({.size = {1 << 20, 8}}, plane_probe()), HasSubstr("at most"));
  EXPECT_THAT(message({.size = {8, 8}, .origin = {0x1p21, 0}}, plane_probe()), HasSubstr("2^20"));
  EXPECT_THAT(message({.size = {8, 8}, .step = 0}, plane_probe()), HasSubstr("step 0"));
  recipe = plane_probe();
  recipe.textures.push_back({.sampler = "big", .size = {1 << 20, 1}, .levels = {{}}});
  EXPECT_THAT(message(frame, recipe), HasSubstr("1048576x1"));
  if (context_->info().software) {
    recipe = plane_probe();
    recipe.textures.push_back(
        {.sampler = "texton", .size = {1, 1}, .filter = ShaderFilter::anisotropic, .levels = {{0.0F}}});
    EXPECT_THAT(message(frame, recipe), HasSubstr("take manual fetches"));
  }
  // Errors leave the context usable.
  EXPECT_EQ(message(frame, plane_probe()), "drawn");
}

INSTANTIATE_TEST_SUITE_P(Paths, RendererTest, testing::Values(ShaderPath::fragment, ShaderPath::compute),
                         [](const auto& path) { return path.param == ShaderPath::compute ? "compute" : "fragment"; });

TEST(ShaderSourceTest, LogsOfBothKindsOfDriversGetTheFilesNames) {
  const ShaderSource source{"", {"compute.glsl", "frame.glsl"}};
  EXPECT_EQ(source.readable("0:12(5): error: `x' undeclared\n1(7) : error C0000: syntax error"),
            "compute.glsl:12(5): error: `x' undeclared\nframe.glsl:7 : error C0000: syntax error");
}

TEST(ShaderSourceTest, EveryFileIsIncludedOnce) {
  const ShaderSource source = shader_source("430 core", "compute.glsl", plane_probe());
  EXPECT_THAT(source.files,
              testing::UnorderedElementsAre("compute.glsl", "plane.glsl", "space.glsl", "surface_frame.glsl",
                                            "frame.glsl", "plane_probe.glsl", "sample.glsl"));
  EXPECT_THAT(source.text, HasSubstr("#define CHANNELS 8"));
  EXPECT_EQ(source.text.find("#include"), std::string::npos);
}

}  // namespace textonbench::renderer_test
