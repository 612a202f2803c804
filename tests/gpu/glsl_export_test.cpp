// Exported functions, compiled alone as a user would, draw what the processor draws.
#include "experiments/glsl_export.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "gpu/program.h"
#include "gpu/texture.h"
#include "methods/base/image_io.h"
#include "tests/gpu/texton_shader.h"
#include "tests/temporary_folder.h"

namespace textonbench::glsl_export_test {

using testing::HasSubstr;
using testing::Not;

constexpr Seed seed{77};
constexpr Extent size{64, 48};

SplineTexton bright_texton(int order, int channels, int kernels) {
  SplineTexton texton = shader_texton(order, channels, kernels);
  for (double& mean : texton.coefficients.mean) mean = 0.5;
  return texton;
}

GlslExport export_of(const SplineTexton& texton, const SplineNoiseOptions& options) {
  return make_glsl_export(
      make_spline_noise(texton, options)->shader({.seed = seed, .fetch = ShaderFetch::manual}).value());
}

class GlslExportTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string reason;
    context_ = test_context(ContextKind::egl, reason);
    if (!context_) GTEST_SKIP() << reason;
  }

  /// The example's picture, with that texture, clamped and linear, first row at 0.
  Image draw(const std::string& example, const Image& texels, bool linear) {
    const GlFunctions& gl = context_->gl();
    const ShaderSource vertex{
        "#version 330 core\nvoid main() {\n"
        "  gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0);\n}\n",
        {}};
    Program program(*context_, {{GL_VERTEX_SHADER, vertex}, {GL_FRAGMENT_SHADER, {example, {}}}});
    program.use();
    std::vector<float> numbers;
    for (int y = 0; y < texels.height(); ++y) {
      for (int x = 0; x < texels.width(); ++x) {
        for (int c = 0; c < 4; ++c) numbers.push_back(c < texels.channels() ? texels.at(c, x, y) : 1.0F);
      }
    }
    GLuint texture = 0;
    gl.GenTextures(1, &texture);
    gl.ActiveTexture(GL_TEXTURE0);
    gl.BindTexture(GL_TEXTURE_2D, texture);
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, texels.width(), texels.height(), 0, GL_RGBA, GL_FLOAT, numbers.data());
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, linear ? GL_LINEAR : GL_NEAREST);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, linear ? GL_LINEAR : GL_NEAREST);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    program.set("texton", std::int32_t{0});
    FrameTarget target(*context_, 1);
    target.resize(size);
    gl.ActiveTexture(GL_TEXTURE0);
    gl.BindTexture(GL_TEXTURE_2D, texture);
    target.bind(false);
    gl.Disable(GL_BLEND);
    gl.DrawArrays(GL_TRIANGLES, 0, 3);
    Image image = target.read(3);
    gl.DeleteTextures(1, &texture);
    context_->check("drawing an exported shader");
    return image;
  }

  std::unique_ptr<Context> context_;
};

double largest_error(const Image& drawn, const Image& expected) {
  double largest = 0;
  for (int c = 0; c < expected.channels(); ++c) {
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        largest = std::max(largest, static_cast<double>(std::abs(drawn.at(c, x, y) - expected.at(c, x, y))));
      }
    }
  }
  return largest;
}

TEST_F(GlslExportTest, IsTheProcessorsPicture) {
  const TemporaryFolder folder;
  for (const int order : {0, 1, 3}) {
    for (const ImpactProcess process : {ImpactProcess::stratified, ImpactProcess::poisson}) {
      for (const int kernels : {1, 2}) {
        const int channels = kernels == 1 ? 3 : 1;
        SCOPED_TRACE(testing::Message() << order << " " << static_cast<int>(process) << " " << kernels);
        const SplineTexton texton = bright_texton(order, channels, kernels);
        const SplineNoiseOptions options{.impacts = process, .mni = process == ImpactProcess::poisson ? 20.0 : 5.0};
        const GlslExport made = export_of(texton, options);
        const Image expected = make_spline_noise(texton, options)->synthesize({.size = size}, seed);
        const std::filesystem::path exported = folder.path() / std::to_string(order * 10 + kernels);
        if (process == ImpactProcess::stratified) {
          write_glsl_export(made, expected, "", exported);
          // A picture of the files' own texture, in both forms.
          const Image exact = draw(made.example, read_image(exported / "texton.exr").image, order > 0);
          const Image rounded = draw(std::regex_replace(made.example, std::regex("#version 330 core\n"),
                                                        "#version 330 core\n#define TEXTON_NOISE_FROM_PNG\n"),
                                     read_image(exported / "texton.png").image, order > 0);
          EXPECT_LT(largest_error(exact, expected), 1.0 / 255);
          EXPECT_LT(largest_error(rounded, expected), 1.0 / 255);
        } else {
          EXPECT_LT(largest_error(draw(made.example, made.texels, order > 0), expected), 1.0 / 255);
        }
      }
    }
  }
}

TEST_F(GlslExportTest, FarPlacesAreExactByTheirCell) {
  const SplineTexton texton = bright_texton(1, 1, 1);
  const SplineNoiseOptions options{.impacts = ImpactProcess::stratified, .mni = 5};
  const GlslExport made = export_of(texton, options);
  constexpr int cell = -100000000;
  const std::string example =
      std::regex_replace(made.example, std::regex(R"(texton_noise\(texton, gl_FragCoord\.xy - 0\.5\))"),
                         "texton_noise(texton, texton_noise_key, ivec2(-100000000), gl_FragCoord.xy - 0.5)");
  ASSERT_NE(example, made.example);
  const Image expected = make_spline_noise(texton, options)
                             ->synthesize({.size = size, .origin = {cell * made.cell, cell * made.cell}}, seed);
  EXPECT_LT(largest_error(draw(example, made.texels, true), expected), 1.0 / 255);
}

TEST(GlslExportFilesTest, StandsAlone) {
  const GlslExport made = export_of(bright_texton(1, 3, 1), {.impacts = ImpactProcess::poisson, .mni = 30});
  EXPECT_THAT(made.function, Not(HasSubstr("#include")));
  EXPECT_THAT(made.function, Not(HasSubstr("#extension")));
  EXPECT_THAT(made.function, Not(HasSubstr("uniform")));
  EXPECT_THAT(made.function, Not(HasSubstr("#version")));
  // 30 impacts whose support is the whole kernel.
  EXPECT_NEAR(made.fetches, 30, 1e-6);
}

TEST(GlslExportFilesTest, AFolderThatExistsIsLeftAlone) {
  const TemporaryFolder folder;
  const SplineTexton texton = bright_texton(1, 1, 1);
  const GlslExport made = export_of(texton, {});
  const auto files = write_glsl_export(made, Image(size, 1), "text", folder.path() / "new");
  EXPECT_EQ(files.size(), 6U);
  for (const auto& file : files) EXPECT_TRUE(std::filesystem::exists(file)) << file;
  try {
    write_glsl_export(made, Image(size, 1), "other", folder.path() / "new");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("new exists: expected a new folder"));
  }
  std::ifstream readme(folder.path() / "new" / "README.md");
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(readme), {}), "text");
  // Nothing is left beside it.
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
  EXPECT_THROW(write_glsl_export(made, Image(size, 1), "", folder.path() / "not" / "there"), std::runtime_error);
}

TEST(GlslExportFilesTest, WhatCannotBeExportedSaysWhy) {
  const auto reason = [](const SplineTexton& texton, const SplineNoiseOptions& options) -> std::string {
    try {
      export_of(texton, options);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "none";
  };
  EXPECT_THAT(reason(bright_texton(2, 1, 1), {}), HasSubstr("orders 0, 1 and 3"));
  EXPECT_THAT(reason(bright_texton(1, 5, 1), {}), HasSubstr("5 channels"));
  EXPECT_THAT(reason(bright_texton(1, 1, 1), {.impacts = ImpactProcess::paper}), HasSubstr("which repeat"));
}

TEST(GlslExportFilesTest, TheReadmeHasTheNumbers) {
  const SplineTexton texton = bright_texton(1, 3, 1);
  const GlslExport made = export_of(texton, {.impacts = ImpactProcess::stratified, .mni = 5});
  const std::string readme = glsl_readme(made, {"cork", "abc", "CC0-1.0", "textonbench export"});
  EXPECT_THAT(readme, HasSubstr(std::to_string(made.fetches).substr(0, 3) + " fetches"));
  EXPECT_THAT(readme, HasSubstr("license CC0-1.0"));
  EXPECT_THAT(readme, HasSubstr("abc"));
  std::ostringstream key;
  key << std::hex << std::uppercase << made.key;
  EXPECT_THAT(readme, HasSubstr(key.str()));
}

}  // namespace textonbench::glsl_export_test
