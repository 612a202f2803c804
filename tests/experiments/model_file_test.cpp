#include "experiments/model_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "experiments/texton_file.h"
#include "methods/base/image_io.h"
#include "methods/base/random.h"
#include "methods/base/spectrum.h"
#include "methods/spot/color_correction.h"
#include "methods/spot/spline_spectrum.h"
#include "methods/spot/texton_error.h"
#include "tests/temporary_folder.h"

namespace textonbench::model_file_test {

using testing::HasSubstr;
using Json = nlohmann::ordered_json;

ModelFile example() {
  ModelFile model{
      .method = "sot",
      .params = {{"support", std::int64_t{5}}, {"mni", 30.5}, {"impacts", std::string("poisson")}, {"x", true}},
      .exemplar = "ring",
      .exemplar_sha256 = "0123",
      .seed = 18446744073709551615U,
      .texton = {.kernels = {}, .support_pixels = 12, .mean = {0.1, 0.2, 1.0 / 3}}};
  for (std::uint64_t k = 0; k < 2; ++k) {
    Image& kernel = model.texton.kernels.emplace_back(Extent{5, 4}, 3);
    for (int c = 0; c < 3; ++c) {
      for (int y = 0; y < 4; ++y)
        fill_normal(Stream(Seed{k}).child(static_cast<std::uint64_t>(c)), static_cast<std::uint64_t>(y), 0,
                    kernel.row(c, y));
    }
  }
  return model;
}

/// Eight channels in three maps.
ModelFile stack_example() {
  ModelFile model = example();
  model.maps = {{"albedo", 3}, {"normal", 3}, {"height", 1}, {"gloss", 1}};
  model.texton = {.kernels = {}, .support_pixels = 6, .mean = std::vector<double>(8, 0.25)};
  Image& kernel = model.texton.kernels.emplace_back(Extent{3, 2}, 8);
  for (int c = 0; c < 8; ++c) kernel.at(c, c % 3, c % 2) = 0.1F * static_cast<float>(c + 1);
  return model;
}

class ModelFileTest : public testing::Test {
 protected:
  std::filesystem::path file() const { return folder_.path() / "model.json"; }
  std::string message_for(const std::string& text) const {
    std::ofstream(file()) << text;
    try {
      read_model_file(file());
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  }
  Json written() const {
    write_model_file(example(), file());
    std::ifstream in(file());
    return Json::parse(in);
  }
  TemporaryFolder folder_;
};

TEST_F(ModelFileTest, AStackKeepsItsMapsAndChannels) {
  const ModelFile model = stack_example();
  write_model_file(model, file());
  const ModelFile read = read_model_file(file());
  EXPECT_EQ(read.maps, model.maps);
  ASSERT_EQ(read.texton.channels(), 8);
  for (int c = 0; c < 8; ++c) {
    EXPECT_EQ(read.texton.kernels[0].at(c, c % 3, c % 2), model.texton.kernels[0].at(c, c % 3, c % 2));
  }
  std::ifstream in(file());
  const Json json = Json::parse(in);
  Json one_missing = json;
  one_missing["maps"].erase(3);
  EXPECT_THAT(message_for(one_missing.dump()), HasSubstr("maps: expected maps of 8 channels in all"));
  Json of_two = json;
  of_two["maps"][0]["channels"] = 2;
  EXPECT_THAT(message_for(of_two.dump()), HasSubstr("maps: expected named maps of 1 or 3 channels"));
  Json nine = json;
  nine["kernels"][0]["channels"] = 9;
  EXPECT_THAT(message_for(nine.dump()), HasSubstr("channels: expected a whole number from 1 to 8"));
}

TEST_F(ModelFileTest, IsReadBackBitForBit) {
  const ModelFile model = example();
  write_model_file(model, file());
  const ModelFile read = read_model_file(file());
  EXPECT_EQ(read.method, model.method);
  EXPECT_EQ(read.params, model.params);
  EXPECT_EQ(read.exemplar, model.exemplar);
  EXPECT_EQ(read.exemplar_sha256, model.exemplar_sha256);
  EXPECT_EQ(read.seed, model.seed);
  EXPECT_EQ(read.texton.mean, model.texton.mean);
  EXPECT_EQ(read.texton.support_pixels, 12);
  ASSERT_EQ(read.texton.kernels.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    for (int c = 0; c < 3; ++c) {
      for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 5; ++x) EXPECT_EQ(read.texton.kernels[k].at(c, x, y), model.texton.kernels[k].at(c, x, y));
      }
    }
  }
}

TEST_F(ModelFileTest, TellsWhatIsWrong) {
  const Json good = written();
  EXPECT_EQ(message_for(good.dump()), "accepted");
  const auto with = [&](const char* key, const Json& value) {
    Json json = good;
    json[key] = value;
    return message_for(json.dump());
  };
  EXPECT_THAT(message_for("{"), HasSubstr("model.json: expected a model that textonbench fit wrote"));
  EXPECT_THAT(message_for("[]"), HasSubstr("expected a JSON object"));
  EXPECT_THAT(message_for("{}"), HasSubstr("model.json: format: missing"));
  EXPECT_THAT(with("format", "other"), HasSubstr("format: expected \"textonbench model\""));
  EXPECT_THAT(with("version", 2), HasSubstr("version: expected a whole number from 1 to 1"));
  EXPECT_THAT(with("mean", {0.1, 0.2}), HasSubstr("mean: expected 3 numbers"));
  EXPECT_THAT(with("support_pixels", 21), HasSubstr("support_pixels: expected a whole number from 1 to 20"));
  EXPECT_THAT(with("seed", -1), HasSubstr("seed"));
  EXPECT_THAT(with("kernels", Json::array()), HasSubstr("kernels: expected a list that is not empty"));
  EXPECT_THAT(with("params", {{"mni", Json::array()}}), HasSubstr("params.mni"));
  Json json = good;
  json["kernels"][1]["width"] = 4;
  EXPECT_THAT(message_for(json.dump()), HasSubstr("values: expected 4 x 4 x 3 numbers, found 60"));
  json = good;
  json["kernels"][0]["values"][7] = nullptr;
  EXPECT_THAT(message_for(json.dump()), HasSubstr("values: expected finite numbers"));
  EXPECT_THROW(read_model_file(folder_.path() / "none.json"), std::invalid_argument);
}

TEST_F(ModelFileTest, SplinesKeepTheirOrderAndArea) {
  ModelFile model = example();
  model.order = 3;
  model.support_area = 41.5;
  write_model_file(model, file());
  const SplineTexton read = read_model_file(file()).spline_texton();
  EXPECT_EQ(read.order, 3);
  EXPECT_EQ(read.support_area, 41.5);
  EXPECT_EQ(read.coefficients.kernels[1].at(2, 4, 3), model.texton.kernels[1].at(2, 4, 3));
  EXPECT_FALSE(written().contains("order")) << "a spot noise has none";
  const auto with = [&](int order, double area) {
    Json json = written();
    json["order"] = order;
    json["support_area"] = area;
    return message_for(json.dump());
  };
  EXPECT_EQ(with(1, 30), "accepted");
  EXPECT_THAT(with(6, 30), HasSubstr("order: expected a whole number from 0 to 5"));
  EXPECT_THAT(with(1, 30.5), HasSubstr("support_area: expected a number above 0, at most 30"));
  EXPECT_THAT(with(1, 0), HasSubstr("support_area: expected a number above 0"));
}

TEST_F(ModelFileTest, ATextonIsAModelOfOneKernelWithoutItsFrame) {
  const Image kernel = example().texton.kernels[0];
  write_texton_file({.order = 0, .mean = {0.5, 0.25, 1}, .coefficients = kernel, .source = "s"},
                    folder_.path() / "a.texton");
  const ModelFile model = read_texton_as_model(folder_.path() / "a.texton");
  EXPECT_EQ(model.texton.support_pixels, 20);
  EXPECT_EQ(model.texton.kernels[0].at(2, 3, 1), kernel.at(2, 3, 1));
  EXPECT_EQ(model.texton.mean[1], 0.25);
  EXPECT_EQ(model.method, "");
  EXPECT_FALSE(model.order);

  Image framed({7, 6}, 3);
  framed.at(0, 1, 1) = 2;
  framed.at(2, 5, 4) = 3;
  write_texton_file({.order = 1, .mean = {}, .coefficients = framed, .source = "s"}, folder_.path() / "b.texton");
  const ModelFile linear = read_texton_as_model(folder_.path() / "b.texton");
  EXPECT_EQ(linear.order, 1);
  EXPECT_EQ(linear.support_area, 30) << "the frame is where the splines of the outer coefficients end";
  EXPECT_EQ(linear.texton.extent(), (Extent{5, 4}));
  EXPECT_EQ(linear.texton.kernels[0].at(0, 0, 0), 2);
  EXPECT_EQ(linear.texton.kernels[0].at(2, 4, 3), 3);

  write_texton_file({.order = 1, .mean = {}, .coefficients = Image({2, 2}, 3), .source = "s"},
                    folder_.path() / "c.texton");
  try {
    read_texton_as_model(folder_.path() / "c.texton");
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("2x2 coefficients of order 1 are nothing but the frame of 1 zeros"));
  }
}

/// Of every published texton: its RME against its image, the colors of its noise, its mean.
TEST_F(ModelFileTest, PublishedTextonsHaveTheErrorsAndColorsOfTheReference) {
  const char* data = std::getenv("TEXTONBENCH_DATA");
  const char* reference = std::getenv("TEXTONBENCH_REFERENCE");
  if (data == nullptr || reference == nullptr) {
    GTEST_SKIP() << "set TEXTONBENCH_DATA and TEXTONBENCH_REFERENCE to folders with textons and their errors";
  }
  std::ifstream in(std::filesystem::path(reference) / "published_textons_rme.json");
  const Json published = Json::parse(in);
  int compared = 0;
  for (const Json& row : published.at("rows")) {
    const std::string name = row.at("name").get<std::string>();
    const std::filesystem::path texton_file =
        std::filesystem::path(data) / "textons" / (name + "_s" + std::to_string(row.at("s").get<int>()) + ".texton");
    const std::filesystem::path picture = std::filesystem::path(data) / (name + ".png");
    if (!std::filesystem::exists(texton_file) || !std::filesystem::exists(picture)) continue;
    const ModelFile model = read_texton_as_model(texton_file);
    ASSERT_EQ(model.order, row.at("order").get<int>()) << texton_file;
    const GaussianModel exemplar = gaussian_model(periodic_component(read_image(picture).image));
    EXPECT_NEAR(relative_model_error(model.texton, exemplar.spectrum, *model.order), row.at("rme").get<double>(), 2e-5)
        << texton_file;
    const Eigen::MatrixXd wanted = color_covariance(exemplar.spectrum);
    EXPECT_LT((color_covariance(model.texton, *model.order) - wanted).norm(), 1e-5 * wanted.norm()) << texton_file;
    const SplineTexton splines = model.spline_texton();
    EXPECT_NEAR(relative_model_error(spline_spectrum(splines, exemplar.spectrum.grid()), exemplar.spectrum),
                row.at("rme").get<double>(), 2e-5);
    EXPECT_EQ(splines.support_area, std::pow(row.at("file_w").get<double>() - 1, 2)) << "side of h is n + order";
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(model.texton.mean[c], exemplar.mean[c], 1e-6);
    ++compared;
  }
  EXPECT_GE(compared, 15);
}

}  // namespace textonbench::model_file_test
