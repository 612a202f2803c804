#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "methods/base/image_io.h"
#include "tests/cli/program.h"
#include "tests/temporary_folder.h"

namespace textonbench::export_glsl_test {

using testing::HasSubstr;

TEST(ExportGlslTest, WritesAFolderWhosePreviewIsTheSampleOfSynth) {
  const TemporaryFolder folder;
  const Outcome outcome = run_program(
      {"export", "glsl", "texton_noise", "white_noise", "-p", "support=9", "--seed", "5", "-o", "white", "--json"},
      {folder.path()});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["samplers"], 1);
  EXPECT_EQ(json["texels"], (std::vector<int>{11, 11}));
  EXPECT_EQ(json["files"].size(), 6U);
  ASSERT_EQ(run_program({"synth", "texton_noise", "white_noise", "-p", "support=9", "--seed", "5", "--size", "256x256",
                         "-o", "synth.png"},
                        {folder.path()})
                .status,
            0);
  EXPECT_EQ(content_of(folder.path() / "white" / "preview.png"), content_of(folder.path() / "synth.png"));
  // Zeros of the frame are one code of the 16-bit picture, the same on all sides.
  const Image codes = read_image(folder.path() / "white" / "texton.png").image;
  for (int i = 0; i < 11; ++i) {
    EXPECT_EQ(codes.at(0, i, 0), codes.at(0, 0, 0));
    EXPECT_EQ(codes.at(0, 10, i), codes.at(0, 0, 0));
  }
}

TEST(ExportGlslTest, WhatCannotBeExportedIsToldAndWritesNothing) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "there");
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
      {{"export", "glsl", "texton_noise", "white_noise", "-o", "there"}, "there exists: expected a new folder"},
      {{"export", "glsl", "lrp", "white_noise", "-o", "new"},
       "export of the shader local_random_phase: expected texton_noise"},
      {{"export", "glsl", "texton_noise", "white_noise", "-p", "order=2", "-o", "new"}, "orders 0, 1 and 3"},
      {{"export", "glsl", "texton_noise", "nothing", "-o", "new"}, "nothing"},
      {{"export", "glsl", "texton_noise", "white_noise"}, "--output"},
      {{"export"}, "expected --csv FOLDER, --sqlite FILE or both, or glsl METHOD EXEMPLAR"}};
  for (const auto& [arguments, expected] : cases) {
    const Outcome outcome = run_program(arguments, {folder.path()});
    EXPECT_EQ(outcome.status, 2) << expected;
    EXPECT_THAT(outcome.err, HasSubstr(expected));
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "new"));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path() / "there"));
}

}  // namespace textonbench::export_glsl_test
