#include "gpu/context.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace textonbench::context_test {

using testing::AnyOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// Runs in a process of its own: exits with 0 after printing the message of a GpuError to standard error.
void tell_why_not(ContextKind kind) {
  try {
    make_context(kind);
  } catch (const GpuError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    std::_Exit(0);
  }
  std::_Exit(1);
}

class ContextTest : public testing::TestWithParam<ContextKind> {
 protected:
  void SetUp() override {
    if (GetParam() == ContextKind::glfw && std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "no display";
    try {
      context_ = make_context(GetParam());
    } catch (const GpuError& error) {
      GTEST_SKIP() << error.what();
    }
  }
  std::unique_ptr<Context> context_;
};

TEST_P(ContextTest, DescribesItself) {
  const ContextInfo& info = context_->info();
  EXPECT_EQ(info.kind, GetParam());
  EXPECT_THAT(info.renderer, Not(IsEmpty()));
  EXPECT_THAT(info.vendor, Not(IsEmpty()));
  EXPECT_THAT(info.version, HasSubstr(std::to_string(info.major) + "." + std::to_string(info.minor)));
  EXPECT_TRUE(info.at_least(4, 1));
  EXPECT_EQ(info.compute(), info.at_least(4, 3));
  EXPECT_EQ(info.software, is_software_renderer(info.renderer));
  EXPECT_EQ(context_kind(context_name(GetParam())), GetParam());
}

TEST_P(ContextTest, TellsErrorsOfTheDriverOnce) {
  context_->gl().Enable(0x1234);
  try {
    context_->check("testing");
    FAIL() << "no error";
  } catch (const GpuError& error) {
    EXPECT_THAT(error.what(), HasSubstr("testing on " + context_->info().renderer));
    EXPECT_THAT(error.what(), HasSubstr("GL_INVALID_ENUM"));
    // The debug output of the driver, which says more, comes first.
    if (context_->info().compute()) {
      EXPECT_THAT(error.what(), HasSubstr("; GL_INVALID_ENUM"));
    }
  }
  EXPECT_NO_THROW(context_->check("testing again"));
}

TEST_P(ContextTest, ContextsOfOneProgramTakeTurns) {
  const std::unique_ptr<Context> other =
      make_context(GetParam() == ContextKind::osmesa ? ContextKind::egl : ContextKind::osmesa);
  for (int turn = 0; turn < 3; ++turn) {
    for (Context* context : {context_.get(), other.get()}) {
      context->make_current();
      GLuint texture = 0;
      context->gl().GenTextures(1, &texture);
      context->gl().BindTexture(GL_TEXTURE_2D, texture);
      EXPECT_NO_THROW(context->check("taking turns"));
      context->gl().DeleteTextures(1, &texture);
    }
  }
}

TEST_P(ContextTest, OneOutlivesAnotherOfItsKind) {
  auto other = make_context(GetParam());
  context_.reset();
  other->make_current();
  EXPECT_NO_THROW(other->check("going on"));
  context_ = make_context(GetParam());
  EXPECT_NO_THROW(context_->check("starting again"));
}

INSTANTIATE_TEST_SUITE_P(Kinds, ContextTest, testing::Values(ContextKind::egl, ContextKind::glfw, ContextKind::osmesa),
                         [](const auto& kind) { return std::string(context_name(kind.param)); });

TEST(Contexts, SoftwareIsKnownByItsName) {
  for (const char* renderer :
       {"llvmpipe (LLVM 15.0.6, 256 bits)", "softpipe", "Software Rasterizer", "Google SwiftShader"}) {
    EXPECT_TRUE(is_software_renderer(renderer)) << renderer;
  }
  for (const char* renderer : {"NVIDIA H200/PCIe/SSE2", "Quadro K5000/PCIe/SSE2", "AMD Radeon RX 6800 (radeonsi)",
                               "Mesa Intel(R) UHD Graphics 620 (KBL GT2)"}) {
    EXPECT_FALSE(is_software_renderer(renderer)) << renderer;
  }
}

TEST(Contexts, NamesAreThoseOfTheLibraries) {
  EXPECT_EQ(context_kind("osmesa"), ContextKind::osmesa);
  try {
    context_kind("vulkan");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("context 'vulkan': expected egl, osmesa or glfw"));
  }
}

TEST(ContextDeathTest, AnOldVersionIsRefusedWithWhatItIs) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  setenv("MESA_GL_VERSION_OVERRIDE", "3.3", 1);
  EXPECT_EXIT(tell_why_not(ContextKind::egl), testing::ExitedWithCode(0),
              AnyOf(HasSubstr("3.3 (Core Profile)"), HasSubstr("libegl1")));
  unsetenv("MESA_GL_VERSION_OVERRIDE");
}

TEST(ContextDeathTest, WithoutADisplayGlfwNamesTheOtherKinds) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const char* display = std::getenv("DISPLAY");
  const std::string before = display == nullptr ? "" : display;
  unsetenv("DISPLAY");
  unsetenv("WAYLAND_DISPLAY");
  EXPECT_EXIT(tell_why_not(ContextKind::glfw), testing::ExitedWithCode(0),
              AnyOf(HasSubstr("--context egl"), HasSubstr("libglfw3")));
  if (display != nullptr) setenv("DISPLAY", before.c_str(), 1);
}

/// A folder whose files have the libraries' names and are none, searched first by a process that starts with it.
TEST(ContextDeathTest, AMissingLibraryIsNamedWithItsPackage) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // starts this program anew, with the variable below
  const std::string folder = testing::TempDir() + "no_gl";
  std::filesystem::create_directories(folder);
  for (const char* name : {"libOSMesa.so.8", "libOSMesa.so.6"}) std::ofstream(folder + "/" + name) << "no library";
  setenv("LD_LIBRARY_PATH", folder.c_str(), 1);
  EXPECT_EXIT(tell_why_not(ContextKind::osmesa), testing::ExitedWithCode(0), HasSubstr("Debian package libosmesa6"));
  unsetenv("LD_LIBRARY_PATH");
}

}  // namespace textonbench::context_test
