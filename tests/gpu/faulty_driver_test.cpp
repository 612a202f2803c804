// Drivers that fail: a true context, some of whose functions are replaced by those of this file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "gpu/program.h"
#include "gpu/renderer.h"
#include "gpu/texture.h"
#include "methods/spot/spline_shader.h"
#include "tests/gpu/texton_shader.h"

namespace textonbench::faulty_driver_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class FaultyContext final : public Context {
 public:
  explicit FaultyContext(Context& driver) : Context(driver.info().kind), driver_(driver) {
    gl_ = driver.gl();
    info_ = driver.info();
    info_.renderer = "a faulty driver";
  }
  void make_current() override { driver_.make_current(); }
  GlFunctions& functions() { return gl_; }
  ContextInfo& claims() { return info_; }

 private:
  Context& driver_;
};

// What the replaced functions do.
GLenum error = GL_NO_ERROR;
GLenum reset_status = GL_NO_ERROR;
GLenum small_limit = 0;
PFNGLGETINTEGERVPROC true_integer = nullptr;

GLenum APIENTRY one_error() { return std::exchange(error, GLenum{GL_NO_ERROR}); }
GLenum APIENTRY lost_error() { return GL_CONTEXT_LOST; }
GLenum APIENTRY told_reset() { return reset_status; }
void APIENTRY small_integer(GLenum which, GLint* value) {
  true_integer(which, value);
  if (which == small_limit) *value = 2;
}
void APIENTRY few_probes(GLenum /*which*/, GLfloat* value) { *value = 4; }
void APIENTRY no_room_2d(GLenum, GLint, GLint, GLsizei, GLsizei, GLint, GLenum, GLenum, const void*) {
  error = GL_OUT_OF_MEMORY;
}
void APIENTRY no_room_3d(GLenum, GLint, GLint, GLsizei, GLsizei, GLsizei, GLint, GLenum, GLenum, const void*) {
  error = GL_OUT_OF_MEMORY;
}
void APIENTRY no_room_in_buffer(GLenum, GLsizeiptr, const void*, GLenum) { error = GL_OUT_OF_MEMORY; }
GLenum APIENTRY incomplete(GLenum /*target*/) { return GL_FRAMEBUFFER_UNSUPPORTED; }

/// Poisson texton noise of one channel: a texture, words and uniforms.
ShaderRecipe noise_recipe() {
  return spline_noise_recipe(shader_texton(1, 1, 1), {.impacts = ImpactProcess::poisson, .mni = 3}, {.seed = Seed{4}});
}

class FaultyDriver : public testing::Test {
 protected:
  void SetUp() override {
    try {
      driver_ = make_context();
    } catch (const GpuError& missing) {
      GTEST_SKIP() << missing.what();
    }
    context_ = std::make_unique<FaultyContext>(*driver_);
    true_integer = driver_->gl().GetIntegerv;
    error = reset_status = GL_NO_ERROR;
  }
  /// Faults leave nothing behind in the driver.
  void TearDown() override {
    if (driver_) {
      EXPECT_NO_THROW(driver_->check("leaving a test"));
    }
  }

  /// The message of the GpuError, or "drawn".
  std::string message(const ShaderRecipe& recipe, Extent size = {8, 4}) {
    try {
      Renderer(*context_, recipe, ShaderPath::fragment).draw({.size = size});
    } catch (const GpuError& told) {
      return told.what();
    }
    return "drawn";
  }
  void limit_to_two(GLenum which) {
    small_limit = which;
    context_->functions().GetIntegerv = small_integer;
  }

  std::unique_ptr<Context> driver_;
  std::unique_ptr<FaultyContext> context_;
};

TEST_F(FaultyDriver, DrawsWithoutAFault) { EXPECT_EQ(message(noise_recipe()), "drawn"); }

TEST_F(FaultyDriver, OutOfMemoryIsToldWithTheBytes) {
  GlFunctions& gl = context_->functions();
  gl.GetError = one_error;
  gl.TexImage2D = no_room_2d;
  EXPECT_THAT(message(noise_recipe(), {250, 100}),
              AllOf(StartsWith("making a frame of 250x100 pixels (0.4 MB) on a faulty driver: "),
                    HasSubstr("GL_OUT_OF_MEMORY (take smaller frames")));
  gl.TexImage2D = driver_->gl().TexImage2D;

  gl.TexImage3D = no_room_3d;
  EXPECT_THAT(message(noise_recipe()),
              AllOf(StartsWith("making the texture texton of "), HasSubstr(" MB)"), HasSubstr("GL_OUT_OF_MEMORY")));
  gl.TexImage3D = driver_->gl().TexImage3D;

  gl.BufferData = no_room_in_buffer;
  EXPECT_THAT(message(noise_recipe()),
              AllOf(StartsWith("making the words thresholds ("), HasSubstr(" MB)"), HasSubstr("GL_OUT_OF_MEMORY")));
  gl.BufferData = driver_->gl().BufferData;
  EXPECT_EQ(message(noise_recipe()), "drawn");
}

TEST_F(FaultyDriver, AContextThatIsLostIsToldWithItsReason) {
  GlFunctions& gl = context_->functions();
  Renderer renderer(*context_, noise_recipe(), ShaderPath::fragment);
  const auto drawing = [&]() -> std::string {
    try {
      renderer.draw({.size = {8, 4}});
    } catch (const GpuError& told) {
      return told.what();
    }
    return "drawn";
  };
  EXPECT_EQ(drawing(), "drawn");
  gl.GetError = lost_error;
  gl.GetGraphicsResetStatus = nullptr;
  EXPECT_THAT(drawing(), AllOf(StartsWith("drawing a frame of 8x4 pixels"), HasSubstr("GL_CONTEXT_LOST"),
                               HasSubstr("run it again")));
  gl.GetGraphicsResetStatus = told_reset;
  reset_status = GL_GUILTY_CONTEXT_RESET;
  EXPECT_THAT(drawing(), AllOf(HasSubstr("longer than the driver allows (take smaller frames)"),
                               Not(HasSubstr("GL_CONTEXT_LOST"))));
  reset_status = GL_INNOCENT_CONTEXT_RESET;
  EXPECT_THAT(drawing(), HasSubstr("another program did (run it again)"));
  reset_status = GL_UNKNOWN_CONTEXT_RESET;
  EXPECT_THAT(drawing(), HasSubstr("the context is lost"));
}

TEST_F(FaultyDriver, TexturesBeyondItsLimitsAreRefused) {
  limit_to_two(GL_MAX_TEXTURE_SIZE);
  EXPECT_THAT(message(noise_recipe()), HasSubstr("a faulty driver takes at most 2 a side"));
  limit_to_two(GL_MAX_ARRAY_TEXTURE_LAYERS);
  ShaderRecipe layers = noise_recipe();
  layers.textures.front().layers = 3;
  EXPECT_THAT(message(layers),
              AllOf(HasSubstr("3 layers: "), HasSubstr("and 2 layers; take smaller or fewer kernels")));
  limit_to_two(GL_MAX_TEXTURE_BUFFER_SIZE);
  EXPECT_THAT(message(noise_recipe()), HasSubstr("words in thresholds: a faulty driver takes 1 to 2"));
}

TEST_F(FaultyDriver, FramesBeyondItsLimitsAreRefused) {
  limit_to_two(GL_MAX_VIEWPORT_DIMS);  // of the width
  EXPECT_THAT(message(noise_recipe()), StartsWith("frame of 8x4 pixels: a faulty driver draws at most 2x"));
  context_->functions().GetIntegerv = true_integer;
  context_->functions().CheckFramebufferStatus = incomplete;
  EXPECT_THAT(message(noise_recipe()), HasSubstr("take another --context"));
}

TEST_F(FaultyDriver, FewProbesOfTheAnisotropicFilterAreTold) {
  context_->claims().software = false;
  context_->claims().major = 4;
  context_->claims().minor = 6;
  context_->functions().GetFloatv = few_probes;
  ShaderRecipe recipe = noise_recipe();
  recipe.textures.front().filter = ShaderFilter::anisotropic;
  EXPECT_THAT(message(recipe), HasSubstr("does at most 4; take trilinear filtering"));
}

TEST_F(FaultyDriver, WhatARecipeDoesNotSetIsNamed) {
  ShaderRecipe recipe = noise_recipe();
  std::erase_if(recipe.uniforms, [](const auto& uniform) { return uniform.first == "cell_side"; });
  EXPECT_THAT(message(recipe),
              StartsWith("the recipe of texton_noise does not set what its shader reads: cell_side; add it to its"));
  recipe = noise_recipe();
  recipe.textures.clear();
  recipe.words.clear();
  EXPECT_THAT(message(recipe), AllOf(HasSubstr("texton"), HasSubstr("thresholds")));
}

TEST_F(FaultyDriver, AUniformOfAnotherTypeIsAnError) {
  ShaderRecipe recipe = noise_recipe();
  const auto side = std::ranges::find_if(recipe.uniforms, [](const auto& it) { return it.first == "cell_side"; });
  ASSERT_NE(side, recipe.uniforms.end());
  side->second = 1.0F;
  EXPECT_THAT(message(recipe), AllOf(StartsWith("setting the uniforms of texton_noise on a faulty driver"),
                                     HasSubstr("GL_INVALID_OPERATION")));
  driver_->forget_complaints();  // its debug output goes to the true context
}

TEST_F(FaultyDriver, EveryStageThatDoesNotCompileIsNamedWithItsLine) {
  const auto compiling = [&](GLenum stage) -> std::string {
    try {
      const Program program(*driver_,
                            {{stage, {"#version 410 core\n#line 1 0\n\nvoid main() { wrong; }\n", {"small.glsl"}}}});
    } catch (const GpuError& told) {
      return told.what();
    }
    return "compiled";
  };
  EXPECT_THAT(compiling(GL_VERTEX_SHADER),
              AllOf(StartsWith("the vertex shader does not compile:\n"), HasSubstr("small.glsl:2")));
  EXPECT_THAT(compiling(GL_FRAGMENT_SHADER),
              AllOf(StartsWith("the fragment shader does not compile:\n"), HasSubstr("small.glsl:2")));
  // The log has told it: nothing is left for the next call.
  EXPECT_NO_THROW(driver_->check("going on"));
}

TEST_F(FaultyDriver, ShadersThatDoNotLinkAreToldWithTheLog) {
  const ShaderSource vertex{"#version 410 core\nvoid main() { gl_Position = vec4(0.0); }\n", {}};
  const ShaderSource fragment{
      "#version 410 core\nvec4 missing();\nout vec4 color;\nvoid main() { color = missing(); }\n", {}};
  try {
    const Program program(*driver_, {{GL_VERTEX_SHADER, vertex}, {GL_FRAGMENT_SHADER, fragment}});
    FAIL() << "linked";
  } catch (const GpuError& told) {
    EXPECT_THAT(told.what(), AllOf(StartsWith("the shaders do not link:\n"), HasSubstr("missing")));
  }
  EXPECT_NO_THROW(driver_->check("going on"));
}

}  // namespace textonbench::faulty_driver_test
