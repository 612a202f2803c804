// Every subcommand as a user meets it: what it prints, what it writes, and how it ends.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "methods/base/image_io.h"
#include "tests/cli/program.h"
#include "tests/temporary_folder.h"

namespace textonbench::cli_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using Json = nlohmann::ordered_json;

class CliTest : public testing::Test {
 protected:
  Outcome run(const std::vector<std::string>& arguments) const { return run_program(arguments, surroundings_); }
  /// The document that a command prints with --json, which must be all of standard output.
  Json run_json(std::vector<std::string> arguments) const {
    arguments.emplace_back("--json");
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return Json::parse(outcome.out);
  }
  std::filesystem::path file(const std::string& name) const { return folder_.path() / name; }
  void write(const std::string& name, const std::string& text) const { std::ofstream(file(name)) << text; }

  TemporaryFolder folder_;
  Surroundings surroundings_{folder_.path()};
};

TEST_F(CliTest, EveryCommandHelpsWithAnExample) {
  for (const std::string command : {"list", "fit", "synth", "measure", "run", "merge", "figures", "report", "claims",
                                    "compare", "baseline", "export"}) {
    const Outcome outcome = run({command, "--help"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_THAT(outcome.out, AllOf(HasSubstr("Example"), HasSubstr("textonbench " + command)));
    EXPECT_EQ(outcome.err, "");
  }
}

TEST_F(CliTest, TellsItsVersion) {
  const Outcome outcome = run({"--version"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, testing::MatchesRegex("textonbench [0-9.]+ \\(commit [0-9a-z]+(, changed)?\\)\n"));
}

TEST_F(CliTest, UnusableCommandLinesEndWithStatus2) {
  write("notes.txt", "no picture");
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
      {{}, "subcommand"},
      {{"lst"}, "lst"},
      {{"list", "method"}, "method"},
      {{"list", "methods", "--jsn"}, "--jsn"},
      {{"synth", "rpm", "white_noise", "-o", "a.png"}, "did you mean \"rpn\"?"},
      {{"synth", "rpn", "white_nose", "-o", "a.png"}, "did you mean \"white_noise\"?"},
      {{"synth", "rpn", "notes.txt", "-o", "a.png"}, "notes.txt"},
      {{"synth", "rpn", "missing.png", "-o", "a.png"}, "missing.png"},
      {{"synth", "rpn", "white_noise", "-o", "a.bmp"}, "a.bmp"},
      {{"synth", "rpn", "white_noise", "-o", "missing/a.png"}, "missing/a.png"},
      {{"synth", "rpn", "white_noise", "-o", "a.png", "-p", "phse=added"}, "did you mean \"phase\"?"},
      {{"synth", "rpn", "white_noise", "-o", "a.png", "-p", "phase=subtracted"}, "subtracted"},
      {{"synth", "rpn", "white_noise", "-o", "a.png", "-p", "phase"}, "phase"},
      {{"synth", "rpn", "white_noise", "-o", "a.png", "--size", "12by7"}, "12by7"},
      {{"synth", "rpn", "white_noise", "-o", "a.png", "--size", "0x7"}, "0x7"},
      {{"synth", "rpn", "white_noise", "-o", "a.png", "--seed", "-1"}, "-1"},
      {{"synth", "rpn", "white_noise", "-o", "a.png", "--size", "64x64"}, "rpn cannot do this"},
      {{"measure", "rpn", "white_noise", "--metrics", "skewnes"}, "did you mean \"skewness\"?"},
      {{"measure", "rpn", "white_noise", "--samples", "0"}, "samples"},
      {{"run", "missing/config"}, "missing/config"},
      {{"run"}, "CONFIG"},
      {{"claims", "--paper", "Lecture 2022"}, "did you mean \"Lectures 2022\"?"},
      {{"claims", "--id", "S99"}, "no claim has \"S99\""},
      {{"claims", "--verdict", "deviate"}, "did you mean \"deviates\"?"},
  };
  for (const auto& [arguments, expected] : cases) {
    const Outcome outcome = run(arguments);
    const std::string command = testing::PrintToString(arguments);
    EXPECT_EQ(outcome.status, 2) << command;
    EXPECT_EQ(outcome.out, "") << command;
    EXPECT_THAT(outcome.err, AllOf(StartsWith("textonbench: error: "), HasSubstr(expected))) << command;
  }
  EXPECT_FALSE(std::filesystem::exists(file("a.png")));
}

TEST_F(CliTest, ListsMethodsMetricsExemplarsAndConfigs) {
  const Json methods = run_json({"list", "methods"})["methods"];
  ASSERT_FALSE(methods.empty());
  EXPECT_EQ(methods[0]["name"], "rpn");
  for (const char* key : {"name", "title", "reference", "params"}) EXPECT_TRUE(methods[0].contains(key)) << key;
  for (const char* key : {"name", "default", "unit", "help"}) {
    EXPECT_TRUE(methods[0]["params"][0].contains(key)) << key;
  }
  EXPECT_EQ(run_json({"list", "metrics"})["metrics"][0]["name"], "rme");
  EXPECT_TRUE(run_json({"list", "configs"})["configs"].is_array());

  bool found = false;
  const Json exemplars = run_json({"list", "exemplars"})["exemplars"];
  for (const Json& exemplar : exemplars) {
    for (const char* key : {"name", "available", "width", "height", "channels", "sha256", "source", "licence"}) {
      EXPECT_TRUE(exemplar.contains(key)) << key;
    }
    if (exemplar["name"] != "white_noise") continue;
    found = true;
    EXPECT_EQ(exemplar["width"], 256);
    EXPECT_EQ(exemplar["channels"], 3);
    EXPECT_EQ(exemplar["sha256"].get<std::string>().size(), 64U);
  }
  EXPECT_TRUE(found);
  EXPECT_THAT(run({"list", "exemplars"}).out, AllOf(HasSubstr("white_noise"), HasSubstr("256x256")));
  EXPECT_THAT(run({"list", "metrics"}).out, AllOf(HasSubstr("METRIC"), HasSubstr("ns_per_pixel")));
  EXPECT_THAT(run({"list", "methods"}).out, HasSubstr("-p phase=added"));
}

TEST_F(CliTest, AFolderOfTheUsersAddsExemplars) {
  ASSERT_EQ(run({"synth", "adsn", "ring", "-o", "mine.png"}).status, 0);
  std::filesystem::create_directory(file("data"));
  std::filesystem::rename(file("mine.png"), file("data/mine.png"));
  surroundings_.environment["TEXTONBENCH_DATA"] = file("data").string();
  EXPECT_THAT(run({"list", "exemplars"}).out, HasSubstr("\nmine "));
  EXPECT_EQ(run({"synth", "rpn", "mine", "-o", "a.png"}).status, 0);
  EXPECT_EQ(run({"synth", "rpn", "data/mine.png", "-o", "b.png"}).status, 0);
  EXPECT_TRUE(content_of(file("a.png")) == content_of(file("b.png")));
}

TEST_F(CliTest, SynthWritesASampleAndTellsAboutIt) {
  const Json told = run_json({"synth", "rpn", "white_noise", "--seed", "3", "-o", "a.png"});
  EXPECT_EQ(told["output"], "a.png");
  EXPECT_EQ(told["seed"], 3);
  EXPECT_EQ(told["size"], Json({256, 256}));
  EXPECT_GT(told["seconds"]["analyze"].get<double>(), 0);
  EXPECT_GT(told["seconds"]["synthesize"].get<double>(), 0);
  EXPECT_EQ(read_image_info(file("a.png")).extent, (Extent{256, 256}));
}

TEST_F(CliTest, ASizeOfOnesOwnIsAWindowOfThePlane) {
  const Json told = run_json({"synth", "adsn", "white_noise", "--size", "100x300", "-o", "a.exr"});
  EXPECT_EQ(told["periodic"], false);
  EXPECT_EQ(read_image_info(file("a.exr")).extent, (Extent{100, 300}));
  EXPECT_EQ(run_json({"synth", "adsn", "white_noise", "-o", "a.exr"})["periodic"], true);
  EXPECT_EQ(run_json({"synth", "adsn", "white_noise", "--no-periodic", "-o", "a.exr"})["periodic"], false);
  EXPECT_EQ(run_json({"synth", "rpn", "white_noise", "--size", "256x256", "--periodic", "-o", "a.exr"})["periodic"],
            true);
}

TEST_F(CliTest, SameSeedSameBitsInEveryProcessAndForEveryNumberOfThreads) {
  for (const std::string method : {"rpn", "adsn"}) {
    for (const std::string extension : {".png", ".exr"}) {
      const std::vector<std::string> command{"synth", method, "ring", "--seed", "7", "-o"};
      std::vector<std::string> contents;
      for (const std::string threads : {"1", "2"}) {
        const std::string name = fmt::format("{}{}{}", method, contents.size(), extension);
        std::vector<std::string> arguments = command;
        arguments.insert(arguments.end(), {name, "--threads", threads});
        ASSERT_EQ(run(arguments).status, 0);
        contents.push_back(content_of(file(name)));
      }
      EXPECT_TRUE(contents[0] == contents[1]) << method << extension;
    }
  }
  ASSERT_EQ(run({"synth", "rpn", "ring", "--seed", "8", "-o", "other.png"}).status, 0);
  EXPECT_FALSE(content_of(file("other.png")) == content_of(file("rpn0.png")));
}

TEST_F(CliTest, MeasureTellsEveryMetric) {
  const Json told = run_json({"measure", "adsn", "ring", "--samples", "2"});
  EXPECT_EQ(told["method"], "adsn");
  EXPECT_EQ(told["exemplar"], "ring");
  EXPECT_TRUE(told["params"].contains("component"));
  const Json metrics = run_json({"list", "metrics"})["metrics"];
  for (const Json& metric : metrics) {
    const std::string name = metric["name"];
    // Theory is tested when asked for, and frames where a graphics processor draws.
    if (metric["identity"].get<bool>() || metric["level"] == "frame") continue;
    if (!told["metrics"].contains(name)) {
      EXPECT_THAT(name, testing::AnyOf("rme_corrected", "kept_variance", "kernel_kurtosis", "predicted_kurtosis",
                                       "local_kurtosis_least", "local_kurtosis_greatest", "poisson_impacts",
                                       "stratified_impacts", "limit_patch_distance"));
      continue;  // of textons, which ADSN has not
    }
    EXPECT_TRUE(told["metrics"][name]["value"].is_number()) << name;
    EXPECT_EQ(told["metrics"][name]["unit"], metric["unit"]);
  }
  const Outcome table = run({"measure", "adsn", "ring", "--samples", "2", "--metrics", "mean_error,rme"});
  EXPECT_THAT(table.out, AllOf(HasSubstr("METRIC"), HasSubstr("mean_error"), HasSubstr("rme"), HasSubstr("±"),
                               Not(HasSubstr("skewness"))));
  EXPECT_FALSE(std::filesystem::exists(file("results"))) << "measuring by hand leaves nothing behind";
}

TEST_F(CliTest, AnOutputThatDoesNotFitOnTheDiskIsAnError) {
  surroundings_.largest_file = 1000;
  const Outcome outcome = run({"synth", "rpn", "white_noise", "-o", "a.png"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, AllOf(StartsWith("textonbench: error: "), HasSubstr("a.png")));
  EXPECT_FALSE(std::filesystem::exists(file("a.png")));
}

TEST_F(CliTest, AHomeFolderWithoutConfigsIsAnError) {
  surroundings_.environment["TEXTONBENCH_HOME"] = folder_.path().string();
  const Outcome outcome = run({"list", "exemplars"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("TEXTONBENCH_HOME"));
}

}  // namespace textonbench::cli_test
