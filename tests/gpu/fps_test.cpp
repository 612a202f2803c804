// Frames on a graphics processor, or in software where there is none.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "gpu/context.h"
#include "methods/base/image_io.h"
#include "tests/cli/program.h"
#include "tests/temporary_folder.h"

namespace textonbench::fps_test {

using testing::HasSubstr;

std::vector<std::string> fps(std::vector<std::string> more) {
  more.insert(more.begin(), {"fps", "texton_noise", "white_noise", "-p", "support=15", "-p", "iterations=2"});
  return more;
}

class FpsTest : public testing::Test {
 protected:
  void SetUp() override {
    try {
      info_ = make_context()->info();
    } catch (const GpuError& error) {
      GTEST_SKIP() << error.what();
    }
  }
  Outcome run(const std::vector<std::string>& arguments) const { return run_program(arguments, {folder_.path()}); }

  const TemporaryFolder folder_;
  ContextInfo info_;
};

TEST_F(FpsTest, JsonHasTheDocumentedFields) {
  const Outcome outcome = run(fps({"--size", "48x32", "--frames", "3", "--path", "fragment", "--half", "--json"}));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["renderer"], info_.renderer);
  EXPECT_EQ(json["vendor"], info_.vendor);
  EXPECT_EQ(json["version"], info_.version);
  EXPECT_EQ(json["software"], info_.software);
  EXPECT_EQ(json["path"], "fragment");
  EXPECT_EQ(json["size"], (nlohmann::json{48, 32}));
  EXPECT_EQ(json["texton"], (nlohmann::json{15, 15}));
  EXPECT_EQ(json["params"]["mni"], 5.0);
  EXPECT_EQ(json["half"], true);
  EXPECT_EQ(json["frames"], 3);
  const double median = json["ms"]["median"];
  EXPECT_GT(median, 0);
  EXPECT_LE(json["ms"]["min"], json["ms"]["p05"]);
  EXPECT_LE(json["ms"]["p05"], median);
  EXPECT_GE(json["ms"]["p95"], median);
  EXPECT_NEAR(json["ns_per_pixel"], 1e6 * median / (48 * 32), 1e-6 * median);
  EXPECT_NEAR(json["fetches_per_pixel"], 5, 1e-3);
  EXPECT_GT(json["fetches_per_second"], 0);
  EXPECT_GT(json["fetch_ceiling_fraction"], 0);
  EXPECT_GT(json["fetch_ceiling"]["incoherent"], 0);
}

/// Local random-phase and Gabor noise read tables, not textures: there is no ceiling of fetches to hold them against.
TEST_F(FpsTest, ShadersWithoutTexturesAreTimed) {
  std::vector<std::string> arguments = fps({"--size", "16x16", "--frames", "1", "--path", "fragment", "--json"});
  arguments[1] = "gabor";
  std::erase_if(arguments, [](const std::string& argument) {
    return argument == "-p" || argument.find('=') != std::string::npos;
  });
  const Outcome outcome = run(arguments);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json json = nlohmann::json::parse(outcome.out);
  EXPECT_GT(json["ns_per_pixel"], 0);
  EXPECT_TRUE(json["fetch_ceiling_fraction"].is_null());
  EXPECT_FALSE(json.contains("texton"));
}

TEST_F(FpsTest, AllPathsAreRowsAndSoftwareIsCalledSo) {
  const Outcome outcome = run(fps({"--size", "16x16", "--frames", "1", "--path", "all", "--scene", "ground"}));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr(info_.renderer));
  EXPECT_THAT(outcome.out, HasSubstr("fragment"));
  EXPECT_EQ(outcome.out.find("compute") != std::string::npos, info_.compute());
  EXPECT_EQ(outcome.out.find("[software]") != std::string::npos, info_.software);
  EXPECT_EQ(outcome.out.find("SOFTWARE FPS") != std::string::npos, info_.software);
  EXPECT_EQ(outcome.err.find("no graphics processor's frame rate") != std::string::npos, info_.software);
}

TEST_F(FpsTest, MixturesAndSpotNoisesAreTimed) {
  const std::vector<std::string> frames{"--size", "32x32", "--frames", "1", "--path", "fragment", "--json"};
  std::vector<std::string> mixing = fps(frames);
  mixing[1] = "mixing";
  mixing.insert(mixing.end(), {"-p", "second=white_noise", "-p", "kernels=3", "-p", "share=0.5"});
  std::vector<std::string> dsn{"fps", "dsn", "white_noise", "-p", "mni=4"};
  dsn.insert(dsn.end(), frames.begin(), frames.end());
  for (const auto& [arguments, impacts] : {std::pair{mixing, 5.0}, std::pair{dsn, 4.0}}) {
    const Outcome outcome = run(arguments);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const nlohmann::json json = nlohmann::json::parse(outcome.out);
    EXPECT_GT(json["ms"]["median"], 0);
    EXPECT_NEAR(json["fetches_per_pixel"], impacts, 0.01);
  }
}

TEST_F(FpsTest, SynthDrawsTheSampleOfTheProcessor) {
  std::vector<std::string> synth = fps({"--size", "40x24", "--seed", "7", "--json", "-o", "cpu.exr"});
  synth.front() = "synth";
  ASSERT_EQ(run(synth).status, 0);
  synth.back() = "gpu.exr";
  synth.insert(synth.end(), {"--renderer", "gpu", "--fetch", "manual", "--path", "fragment"});
  const Outcome outcome = run(synth);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(nlohmann::json::parse(outcome.out)["gpu"]["renderer"], info_.renderer);
  const Image cpu = read_image(folder_.path() / "cpu.exr").image;
  const Image gpu = read_image(folder_.path() / "gpu.exr").image;
  ASSERT_EQ(gpu.extent(), cpu.extent());
  for (int c = 0; c < cpu.channels(); ++c) {
    for (int y = 0; y < cpu.height(); ++y) {
      for (int x = 0; x < cpu.width(); ++x) ASSERT_NEAR(gpu.at(c, x, y), cpu.at(c, x, y), 1e-5) << x << ", " << y;
    }
  }
}

TEST_F(FpsTest, WhatTheRendererCannotDoIsTold) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
      {{"fps", "adsn", "white_noise"},
       "adsn has no shader for a graphics processor: expected one of dsn, texton_noise"},
      {{"fps", "dsn", "white_noise", "-p", "impacts=gaussian"}, "expected impacts = poisson or stratified"},
      {{"fps", "dsn", "white_noise", "--scene", "ground"}, "whole points of the plane alone"},
      {fps({"--size", "100000x2"}), "frame of 100000x2 pixels"},
      {fps({"--pitch", "20"}), "--pitch on the scene plane: expected --scene ground"},
      {fps({"--tilt", "20", "--scene", "ground"}), "--tilt on the scene ground: expected --scene sphere"},
      {fps({"--scene", "nothing.obj"}), "scene nothing.obj: no such file"},
      {fps({"--scene", "sphere", "--bump", "3", "-p", "order=0"}), "has no gradients"},
      {fps({"-p", "order=5"}), "take manual fetches"},
      {{"synth", "texton_noise", "white_noise", "--renderer", "gpu", "--path", "all", "-o", "x.png"},
       "expected one path"},
      {{"synth", "rpn", "white_noise", "--renderer", "gpu", "-o", "x.png"}, "expected --no-periodic or --size"}};
  for (const auto& [arguments, expected] : cases) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 2) << expected;
    EXPECT_THAT(outcome.err, HasSubstr(expected));
    EXPECT_EQ(outcome.out, "");
  }
}

TEST(FpsInputTest, BadOptionsAreRefused) {
  const TemporaryFolder folder;
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
      {fps({"--context", "mir"}), "egl"},
      {fps({"--path", "vertex"}), "fragment"},
      {fps({"--filter", "box"}), "anisotropic"},
      {fps({"--frames", "0"}), "--frames"},
      {fps({"--supersampling", "65"}), "--supersampling"},

      {{"synth", "texton_noise", "white_noise", "--renderer", "tpu", "-o", "x.png"}, "cpu"},
      {{"synth", "texton_noise", "white_noise", "--half", "-o", "x.png"}, "expected --renderer gpu"}};
  for (const auto& [arguments, expected] : cases) {
    const Outcome outcome = run_program(arguments, {folder.path()});
    EXPECT_EQ(outcome.status, 2) << expected;
    EXPECT_THAT(outcome.err, HasSubstr(expected));
  }
}

}  // namespace textonbench::fps_test
