// Stacks of maps from files to files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "methods/base/image_io.h"
#include "methods/base/spectrum.h"
#include "tests/cli/program.h"
#include "tests/temporary_folder.h"
#include "tests/texture.h"

namespace textonbench::stack_test {

using testing::ElementsAre;
using testing::HasSubstr;
using Json = nlohmann::ordered_json;

/// 1.4 − twice the mean of the colors: high where the colors are dark.
Image height_of(const Image& color) {
  Image height(color.extent(), 1);
  for (int y = 0; y < color.height(); ++y) {
    for (int x = 0; x < color.width(); ++x) {
      height.at(0, x, y) = 1.4F - 2.0F / 3 * (color.at(0, x, y) + color.at(1, x, y) + color.at(2, x, y));
    }
  }
  return height;
}

double correlation(const Image& a, int c, const Image& b, int d) {
  const double mean_a = channel_means(a)[static_cast<std::size_t>(c)];
  const double mean_b = channel_means(b)[static_cast<std::size_t>(d)];
  double ab = 0, aa = 0, bb = 0;
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x) {
      const double va = a.at(c, x, y) - mean_a, vb = b.at(d, x, y) - mean_b;
      ab += va * vb;
      aa += va * va;
      bb += vb * vb;
    }
  }
  return ab / std::sqrt(aa * bb);
}

bool same(const Image& a, const Image& b) {
  if (a.extent() != b.extent() || a.channels() != b.channels()) return false;
  for (int i = 0; i < a.channels() * a.height(); ++i) {
    if (!std::ranges::equal(a.row(i / a.height(), i % a.height()), b.row(i / a.height(), i % a.height()))) return false;
  }
  return true;
}

class StackTest : public testing::Test {
 protected:
  StackTest() {
    const Image albedo = test_texture({40, 32}, 3);
    write_image(albedo, folder_.path() / "albedo.png");
    write_image(height_of(albedo), folder_.path() / "height.png");
  }
  Outcome run(const std::vector<std::string>& arguments) const { return run_program(arguments, {folder_.path()}); }
  Json run_json(std::vector<std::string> arguments) const {
    arguments.emplace_back("--json");
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return Json::parse(outcome.out);
  }
  ReadResult read(const std::string& name) const { return read_image(folder_.path() / name); }

  TemporaryFolder folder_;
};

TEST_F(StackTest, AStackBecomesNamedChannelsOfOneExr) {
  for (const char* method : {"texton_noise", "adsn", "sot"}) {
    run_json({"synth", method, "albedo.png+height.png", "--size", "96x64", "-o", "out.exr"});
    const ReadResult out = read("out.exr");
    EXPECT_THAT(out.maps, ElementsAre(ImageMap{"albedo", 3}, ImageMap{"height", 1}));
    EXPECT_EQ(out.image.extent(), (Extent{96, 64}));
    // −1 in the exemplar, up to rounding to 8 bits.
    const Image mean = height_of(out.image);
    EXPECT_GT(correlation(mean, 0, out.image, 3), 0.95) << method;
    for (int c = 0; c < 3; ++c) EXPECT_LT(correlation(out.image, c, out.image, 3), -0.8) << method << ' ' << c;
  }
}

TEST_F(StackTest, AStackBecomesOnePngAMap) {
  const Json told = run_json({"synth", "rpn", "albedo.png+height.png", "-o", "out.png"});
  EXPECT_EQ(told["files"], (Json{"out_albedo.png", "out_height.png"}));
  EXPECT_EQ(read("out_albedo.png").image.channels(), 3);
  EXPECT_EQ(read("out_height.png").image.channels(), 1);
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "out.png"));
  EXPECT_LT(correlation(read("out_albedo.png").image, 0, read("out_height.png").image, 0), -0.8);
}

TEST_F(StackTest, AFittedStackKeepsItsMaps) {
  const std::vector<std::string> options{"-p", "support=9", "-p", "mni=12"};
  const auto with = [&](std::vector<std::string> start) {
    start.insert(start.end(), options.begin(), options.end());
    return start;
  };
  const Json fitted = run_json(with({"fit", "texton_noise", "albedo.png+height.png", "-o", "model"}));
  EXPECT_EQ(fitted["files"], (Json{"model.json", "model.exr", "model_albedo.texton", "model_height.texton"}));
  EXPECT_THAT(read("model.exr").maps, ElementsAre(ImageMap{"albedo", 3}, ImageMap{"height", 1}));
  run_json(with({"synth", "texton_noise", "albedo.png+height.png", "--size", "64x48", "-o", "direct.exr"}));
  run_json({"synth", "--model", "model.json", "--size", "64x48", "-o", "read.exr"});
  const ReadResult direct = read("direct.exr");
  EXPECT_EQ(read("read.exr").maps, direct.maps);
  EXPECT_TRUE(same(read("read.exr").image, direct.image));
  // The textons of single maps share their impacts.
  run_json({"synth", "--model", "model_height.texton", "-p", "mni=12", "--size", "64x48", "-o", "height.exr"});
  EXPECT_GT(correlation(read("height.exr").image, 0, direct.image, 3), 0.9999);
}

TEST_F(StackTest, AStackIsMeasuredAndRepeatedByItsName) {
  const Json measured = run_json({"measure", "sot", "albedo.png+height.png", "-p", "support=9", "--samples", "2",
                                  "--metrics", "rme,color_covariance_error,patch_distance,excess_kurtosis"});
  EXPECT_EQ(measured["exemplar"], "albedo.png+height.png");
  EXPECT_EQ(measured["metrics"].size(), 4U);
}

TEST_F(StackTest, UnusableStacksAreBadInput) {
  write_image(test_texture({40, 32}, 3, 2), folder_.path() / "normal.png");
  write_image(test_texture({40, 32}, 3, 3), folder_.path() / "metal.png");
  write_image(test_texture({20, 32}, 1), folder_.path() / "narrow.png");
  const auto expect_refused = [&](const std::vector<std::string>& arguments, const std::string& reason) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 2) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(reason));
  };
  expect_refused({"synth", "sot", "albedo.png+normal.png+metal.png", "-o", "out.exr"},
                 "9 channels in 3 maps: expected at most 8");
  expect_refused({"synth", "sot", "albedo.png+narrow.png", "-o", "out.exr"},
                 "albedo.png has 40x32 pixels and narrow.png has 20x32");
  expect_refused({"synth", "luminance_texton", "albedo.png+height.png", "-o", "out.exr"}, "has 4 channels");
}

}  // namespace textonbench::stack_test
