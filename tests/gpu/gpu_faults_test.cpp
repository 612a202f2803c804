// What the program does where OpenGL is missing or too weak: the reason, what to do, and status 2; the processor draws.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "gpu/context.h"
#include "tests/cli/program.h"
#include "tests/temporary_folder.h"

namespace textonbench::gpu_faults_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class GpuFaults : public testing::Test {
 protected:
  Outcome run(std::vector<std::string> arguments, const std::vector<std::string>& more = {}) const {
    arguments.insert(arguments.end(), {"texton_noise", "white_noise", "-p", "support=15", "-p", "iterations=2"});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments, {folder_.path(), environment_});
  }
  Outcome fps(std::vector<std::string> more) const {
    more.insert(more.end(), {"--frames", "1"});
    return run({"fps"}, more);
  }
  Outcome synth(const std::vector<std::string>& more) const { return run({"synth", "-o", "sample.exr"}, more); }

  /// Its message has to end the program with status 2, without a line on standard output or a file.
  void expect_refused(const Outcome& outcome, const testing::Matcher<const std::string&>& message) const {
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.out, IsEmpty());
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("textonbench: error: "), message));
    EXPECT_FALSE(std::filesystem::exists(folder_.path() / "sample.exr"));
  }
  void expect_drawn_by_the_processor() const {
    const Outcome outcome = synth({"--size", "16x16"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_TRUE(std::filesystem::exists(folder_.path() / "sample.exr"));
  }
  /// Files of the libraries' names that are none, in a folder that is searched first.
  void hide(const std::vector<std::string>& libraries) {
    const std::filesystem::path folder = folder_.path() / "no_libraries";
    std::filesystem::create_directories(folder);
    for (const std::string& name : libraries) std::ofstream(folder / name) << "no library";
    environment_["LD_LIBRARY_PATH"] = folder.string();
  }

  const TemporaryFolder folder_;
  std::map<std::string, std::string> environment_;
};

TEST_F(GpuFaults, NoLibraryAtAll) {
  hide({"libEGL.so.1", "libOSMesa.so.8", "libOSMesa.so.6", "libglfw.so.3"});
  const auto reasons = AllOf(HasSubstr("no OpenGL here:\n  egl: "), HasSubstr("libEGL.so.1"),
                             HasSubstr("Debian package libegl1\n  osmesa: "), HasSubstr("libOSMesa.so.8"),
                             HasSubstr("Debian package libosmesa6\n  glfw: "), HasSubstr("libglfw.so.3"),
                             HasSubstr("Debian package libglfw3\n"), HasSubstr("synth without --renderer gpu"));
  expect_refused(fps({}), reasons);
  expect_refused(synth({"--renderer", "gpu", "--size", "16x16"}), reasons);
  expect_refused(fps({"--context", "egl"}), HasSubstr("install the Debian package libegl1"));
  expect_drawn_by_the_processor();
}

TEST_F(GpuFaults, AMachineWhoseEglHasNoDriver) {
  environment_["__EGL_VENDOR_LIBRARY_FILENAMES"] = (folder_.path() / "no_vendor.json").string();
  expect_refused(fps({"--context", "egl"}),
                 AllOf(HasSubstr("libegl"), testing::AnyOf(HasSubstr("none at all"), HasSubstr("install"))));
  expect_refused(synth({"--renderer", "gpu", "--context", "egl"}), HasSubstr("install"));
  // OSMesa is taken instead.
  try {
    make_context(ContextKind::osmesa);
  } catch (const GpuError& missing) {
    GTEST_SKIP() << missing.what();
  }
  const Outcome outcome = fps({"--size", "16x16", "--json"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("\"context\": \"osmesa\""));
}

TEST_F(GpuFaults, EglTellsItsErrorsByName) {
  const std::string mesa = "/usr/share/glvnd/egl_vendor.d/50_mesa.json";
  if (!std::filesystem::exists(mesa)) GTEST_SKIP() << "no " << mesa;
  environment_ = {{"__EGL_VENDOR_LIBRARY_FILENAMES", mesa}, {"LIBGL_DRIVERS_PATH", folder_.path().string()}};
  expect_refused(fps({"--context", "egl"}),
                 AllOf(HasSubstr("does not start: EGL_NOT_INITIALIZED"), HasSubstr("libgl1-mesa-dri"),
                       HasSubstr("--context osmesa"), Not(HasSubstr("0x3"))));
}

TEST_F(GpuFaults, AnOldVersion) {
  environment_ = {{"MESA_GL_VERSION_OVERRIDE", "3.3"}, {"DISPLAY", ""}, {"WAYLAND_DISPLAY", ""}};
  const Outcome outcome = fps({"--size", "16x16"});
  if (outcome.status == 0) GTEST_SKIP() << "not Mesa: " << outcome.out;
  expect_refused(outcome, AllOf(HasSubstr("  egl: "), HasSubstr("  osmesa: "), HasSubstr("  glfw: ")));
  expect_refused(synth({"--renderer", "gpu", "--size", "16x16"}), HasSubstr("no OpenGL here:\n"));
  expect_drawn_by_the_processor();
}

TEST_F(GpuFaults, AVersionWithoutComputeShaders) {
  environment_["MESA_GL_VERSION_OVERRIDE"] = "4.1";
  const Outcome fragment = fps({"--context", "osmesa", "--size", "16x16", "--path", "all"});
  if (fragment.status != 0) GTEST_SKIP() << fragment.err;
  EXPECT_THAT(fragment.out, AllOf(HasSubstr("fragment"), Not(HasSubstr("compute"))));
  expect_refused(fps({"--context", "osmesa", "--size", "16x16", "--path", "compute"}),
                 AllOf(HasSubstr("compute shaders need OpenGL 4.3"), HasSubstr("has 4.1: take the fragment path")));
}

TEST_F(GpuFaults, NoDisplay) {
  environment_ = {{"DISPLAY", ""}, {"WAYLAND_DISPLAY", ""}};
  expect_refused(fps({"--context", "glfw"}), testing::AnyOf(HasSubstr("--context osmesa"), HasSubstr("libglfw3")));
}

/// Told before anything of that size is made or counted through.
TEST_F(GpuFaults, FramesBeyondTheLimits) {
  try {
    make_context();
  } catch (const GpuError& missing) {
    GTEST_SKIP() << missing.what();
  }
  const auto limits = AllOf(HasSubstr(" draws at most "), HasSubstr("take a smaller one, or the processor"));
  expect_refused(fps({"--size", "100000x100000"}), AllOf(HasSubstr("frame of 100000x100000 pixels: "), limits));
  expect_refused(fps({"--size", "100000x100000", "--scene", "ground"}), limits);
  expect_refused(synth({"--renderer", "gpu", "--size", "100000x100000"}), limits);
}

}  // namespace textonbench::gpu_faults_test
