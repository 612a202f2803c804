// Textons written to files and read back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "methods/base/image_io.h"
#include "methods/base/random.h"
#include "tests/cli/program.h"
#include "tests/temporary_folder.h"

namespace textonbench::fit_test {

using testing::AllOf;
using testing::HasSubstr;
using Json = nlohmann::ordered_json;

class FitTest : public testing::Test {
 protected:
  Outcome run(const std::vector<std::string>& arguments) const { return run_program(arguments, {folder_.path()}); }
  Json run_json(std::vector<std::string> arguments) const {
    arguments.emplace_back("--json");
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return Json::parse(outcome.out);
  }
  std::filesystem::path file(const std::string& name) const { return folder_.path() / name; }
  Image picture(const std::string& name) const { return read_image(file(name)).image; }

  TemporaryFolder folder_;
};

double largest_difference(const Image& a, const Image& b) {
  double largest = 0;
  for (int c = 0; c < a.channels(); ++c) {
    for (int y = 0; y < a.height(); ++y) {
      for (int x = 0; x < a.width(); ++x) {
        largest = std::max(largest, std::fabs(double{a.at(c, x, y)} - b.at(c, x, y)));
      }
    }
  }
  return largest;
}

TEST_F(FitTest, AModelReadBackMakesTheSamePicture) {
  const std::vector<std::string> options{"ring", "-p", "support=9", "-p", "impacts=poisson", "-p", "mni=12"};
  const auto with = [&](std::vector<std::string> start, const std::vector<std::string>& end) {
    start.insert(start.end(), options.begin(), options.end());
    start.insert(start.end(), end.begin(), end.end());
    return start;
  };
  const Json fitted = run_json(with({"fit", "sot"}, {"-o", "model"}));
  EXPECT_EQ(fitted["files"], (Json{"model.json", "model.exr", "model.texton"}));
  EXPECT_EQ(fitted["kernels"], 1);
  EXPECT_EQ(fitted["support_pixels"], 81);
  EXPECT_GT(fitted["rme"], 0.1);
  EXPECT_LT(fitted["rme"], 1);
  run_json(with({"synth", "sot"}, {"--size", "64x48", "-o", "direct.exr"}));
  run_json({"synth", "--model", "model.json", "--size", "64x48", "-o", "read.exr"});
  EXPECT_EQ(largest_difference(picture("direct.exr"), picture("read.exr")), 0);
  // The text format knows neither the process nor the number of impacts.
  run_json({"synth", "--model", "model.texton", "-p", "mni=12", "--size", "64x48", "-o", "text.exr"});
  EXPECT_LT(largest_difference(picture("direct.exr"), picture("text.exr")), 1e-5);
  run_json({"synth", "--model", "model.json", "-p", "impacts=stratified", "-o", "other.exr"});
  EXPECT_EQ(picture("other.exr").extent(), (Extent{512, 512}));
}

TEST_F(FitTest, TheHistoryHasALineAStepAndEndsAtTheError) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
      {{"fit", "sot", "ring", "-p", "support=7", "-p", "iterations=12"}, "iteration"},
      {{"fit", "optimal_texton", "ring", "-p", "support=7", "-p", "kernels=2", "-p", "evaluations=12"}, "evaluation"}};
  for (auto [arguments, step] : cases) {
    arguments.insert(arguments.end(), {"--history", "history.csv", "-o", "model"});
    const Json fitted = run_json(arguments);
    std::ifstream csv(file("history.csv"));
    std::string line;
    std::getline(csv, line);
    EXPECT_EQ(line, step + ",rme");
    double last = 2;  // white kernels start above 1
    int lines = 0;
    while (std::getline(csv, line)) {
      ++lines;
      const std::size_t comma = line.find(',');
      EXPECT_EQ(line.substr(0, comma), std::to_string(lines));
      const double rme = std::stod(line.substr(comma + 1));
      EXPECT_LT(rme, last + 1e-6) << step << " " << lines;
      last = rme;
    }
    EXPECT_EQ(lines, 12);
    EXPECT_EQ(fitted["convergence"]["step"], step);
    EXPECT_EQ(fitted["convergence"]["steps"], 12);
    EXPECT_EQ(fitted["convergence"]["reason"], step + "s");
    EXPECT_EQ(fitted["convergence"]["rme"], last);
    EXPECT_NEAR(fitted["rme"], last, 1e-5) << "nothing was done to the texton afterwards";
  }
  const Outcome early =
      run({"fit", "sot", "ring", "-p", "support=7", "-p", "iterations=500", "-p", "tolerance=0.01", "-o", "model"});
  EXPECT_EQ(early.status, 0);
  EXPECT_THAT(early.err, AllOf(HasSubstr("RME after iteration "), HasSubstr("stopped by: tolerance")));
  EXPECT_EQ(run_json({"fit", "luminance_texton", "ring", "-o", "model"})["convergence"], nullptr);
}

TEST_F(FitTest, SeveralKernelsAreSeveralFiles) {
  const Json fitted = run_json(
      {"fit", "optimal_texton", "ring", "-p", "support=7", "-p", "kernels=2", "-p", "evaluations=5", "-o", "k"});
  EXPECT_EQ(fitted["files"], (Json{"k.json", "k_1.exr", "k_1.texton", "k_2.exr", "k_2.texton"}));
  const Outcome outcome = run({"synth", "--model", "k.json", "--size", "40x30", "-o", "k.png"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
}

TEST_F(FitTest, AGrayExemplarStoredAsRgbGivesAGrayTexton) {
  // Its covariance of colors is singular; corrections and constraints then act in the one color that there is.
  Image gray({40, 40}, 3);
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < 40; ++y) {
      fill_normal(Stream(Seed{5}), static_cast<std::uint64_t>(y), 0, gray.row(c, y));
    }
  }
  write_image(gray, file("gray.exr"));
  for (const std::string method : {"sot", "luminance_texton", "optimal_texton"}) {
    for (const std::string correction : {"authors", "transport", "constrained"}) {
      std::vector<std::string> arguments{"fit", method, "gray.exr", "-p", "support=7", "-o", "texton"};
      if (method == "luminance_texton" && correction != "authors") continue;
      if (method == "sot" && correction == "constrained") continue;
      if (method != "luminance_texton") arguments.insert(arguments.end(), {"-p", "color_correction=" + correction});
      if (method == "optimal_texton") arguments.insert(arguments.end(), {"-p", "kernels=1"});
      const double rme = run_json(arguments)["rme"];
      EXPECT_GT(rme, 0.1) << method << " " << correction;
      EXPECT_LT(rme, 1.2) << method << " " << correction;
      const Image kernel = picture("texton.exr");
      EXPECT_EQ(kernel.extent(), (Extent{7, 7}));
      for (int y = 0; y < 7; ++y) {
        for (int x = 0; x < 7; ++x) {
          EXPECT_NEAR(kernel.at(0, x, y), kernel.at(2, x, y), 1e-4) << method << " " << correction;
        }
      }
    }
  }
}

TEST_F(FitTest, SplinesReadBackMakeTheSamePicture) {
  const std::vector<std::string> options{"ring", "-p",   "support=8", "-p", "order=1", "-p", "impacts=poisson",
                                         "-p",   "mni=9"};
  const auto with = [&](std::vector<std::string> start, const std::vector<std::string>& end) {
    start.insert(start.end(), options.begin(), options.end());
    start.insert(start.end(), end.begin(), end.end());
    return start;
  };
  const Json fitted = run_json(with({"fit", "texton_noise"}, {"-o", "model"}));
  EXPECT_EQ(fitted["files"], (Json{"model.json", "model.exr", "model.texton"}));
  EXPECT_EQ(fitted["size"], (Json{8, 8}));
  EXPECT_LT(fitted["rme"], 1);
  EXPECT_EQ(picture("model.exr").extent(), (Extent{8, 8}));
  run_json(with({"synth", "texton_noise"}, {"--size", "50x41", "-o", "direct.exr"}));
  run_json({"synth", "--model", "model.json", "--size", "50x41", "-o", "read.exr"});
  EXPECT_EQ(largest_difference(picture("direct.exr"), picture("read.exr")), 0);
  run_json({"synth", "--model", "model.texton", "-p", "impacts=poisson", "-p", "mni=9", "--size", "50x41", "-o",
            "text.exr"});
  EXPECT_LT(largest_difference(picture("direct.exr"), picture("text.exr")), 1e-5);
  const Outcome torus = run({"synth", "--model", "model.json", "--periodic", "-o", "torus.png"});
  EXPECT_EQ(torus.status, 2);
  EXPECT_THAT(torus.err, HasSubstr("torus"));
}

TEST_F(FitTest, WhatCannotBeFittedOrReadEndsWithStatus2) {
  write_image(Image({9, 8}, 1), file("black.png"));
  Image wide({300, 8}, 1);
  for (int y = 0; y < 8; ++y) std::ranges::fill(wide.row(0, y), 1.0F);
  write_image(wide, file("wide.png"));
  write_image(crop(wide, 0, 0, {8, 8}), file("constant.png"));
  Image bad({12, 12}, 1);
  bad.at(0, 3, 4) = std::nanf("");
  write_image(bad, file("nan.exr"));
  std::ofstream(file("cut.texton")) << "TEXTON\n1\n0\n0 0 0\n2 2\n1 1 1\n";
  std::ofstream(file("good.texton")) << "TEXTON\n1\n0\n0 0 0\n1 1\n1 1 1\nsource\n";
  std::ofstream(file("frame.texton")) << "TEXTON\n1\n1\n0 0 0\n1 1\n0 0 0\nsource\n";
  std::ofstream(file("broken.json")) << "{\"format\": \"textonbench model\"";
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
      {{"fit", "rpn", "ring", "-o", "m"}, "rpn has no texton to write"},
      {{"fit", "sot", "ring", "-p", "support=300", "-o", "m"}, "300"},
      {{"fit", "sot", "ring", "-p", "support=5", "-o", "missing/m"}, "missing/m"},
      {{"fit", "canonical_texton", "ring", "-o", "m"}, "gray"},
      {{"fit", "luminance_texton", "ring", "--history", "h.csv", "-o", "m"}, "--history: luminance_texton"},
      {{"synth", "--model", "none.json", "-o", "a.png"}, "none.json: no such file"},
      {{"synth", "--model", "cut.texton", "-o", "a.png"},
       "cut.texton:5: 2 x 2 coefficients announced and 6 bytes left"},
      {{"synth", "--model", "frame.texton", "-o", "a.png"}, "1x1 coefficients of order 1 are nothing but the frame"},
      {{"fit", "texton_noise", "ring", "-p", "support=5", "-p", "kernels=2", "-o", "m"}, "fit = direct"},
      {{"synth", "--model", "broken.json", "-o", "a.png"}, "broken.json: expected a model"},
      {{"synth", "--model", "good.texton", "-p", "support=3", "-o", "a.png"}, "support"},
      {{"synth", "sot", "ring", "--model", "cut.texton", "-o", "a.png"}, "either METHOD EXEMPLAR or --model FILE"},
      {{"synth", "-o", "a.png"}, "either METHOD EXEMPLAR or --model FILE"},
      {{"synth", "sot", "ring", "-p", "mni=0", "-o", "a.png"}, "mni"},
      {{"synth", "sot", "ring", "-p", "mni=-3", "-o", "a.png"}, "mni"},
      {{"synth", "sot", "ring", "-p", "mni=nan", "-o", "a.png"}, "mni"},
      {{"synth", "sot", "ring", "-p", "impacts=stratified", "-p", "mni=1e9", "-o", "a.png"},
       "expected 1e-12 to 64 for stratified impacts"},
      {{"synth", "sot", "nan.exr", "-p", "support=3", "-o", "a.png"}, "sample nan at x 3, y 4, channel 0"},
      {{"synth", "sot", "ring", "-p", "shape=mask", "-p", "mask=nan.exr", "-o", "a.png"}, "nan.exr"},
      {{"synth", "dsn", "ring", "-p", "border=129", "-o", "a.png"}, "border of 129 pixels on a spot of 256x256"},
      {{"synth", "sot", "ring", "-p", "impacts=poisson", "-p", "mni=1e300", "-o", "a.png"}, "mni"},
      {{"synth", "sot", "ring", "-p", "shape=mask", "-p", "mask=none.png", "-o", "a.png"}, "none.png"},
      {{"synth", "sot", "ring", "-p", "shape=mask", "-p", "mask=black.png", "-o", "a.png"},
       "black.png: support mask of 9x8"},
      {{"synth", "sot", "ring", "-p", "shape=mask", "-p", "mask=wide.png", "-o", "a.png"},
       "wide.png: support of 300x8"},
      {{"synth", "sot", "constant.png", "-p", "support=3", "-o", "a.png"}, "constant"},
      {{"synth", "optimal_texton", "constant.png", "-p", "support=3", "-o", "a.png"}, "constant"},
  };
  for (const auto& [arguments, message] : cases) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 2) << message;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("textonbench: error: "), HasSubstr(message)));
    EXPECT_EQ(outcome.out, "") << message;
  }
  EXPECT_FALSE(std::filesystem::exists(file("m.json")));
  EXPECT_FALSE(std::filesystem::exists(file("a.png")));
}

}  // namespace textonbench::fit_test
