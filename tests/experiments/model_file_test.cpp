#include "experiments/model_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "experiments/texton_file.h"
#include "methods/base/random.h"
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

TEST_F(ModelFileTest, ATextonOfOrderZeroIsAModel) {
  const TextonFile texton{
      .order = 0, .mean = {0.5, 0.25, 1}, .coefficients = example().texton.kernels[0], .source = "s"};
  write_texton_file(texton, folder_.path() / "a.texton");
  const ModelFile model = read_texton_as_model(folder_.path() / "a.texton");
  EXPECT_EQ(model.texton.support_pixels, 20);
  EXPECT_EQ(model.texton.kernels[0].at(2, 3, 1), texton.coefficients.at(2, 3, 1));
  EXPECT_EQ(model.texton.mean[1], 0.25);
  EXPECT_EQ(model.method, "");
  write_texton_file({.order = 1, .mean = {}, .coefficients = Image({3, 3}, 3), .source = "s"},
                    folder_.path() / "b.texton");
  try {
    read_texton_as_model(folder_.path() / "b.texton");
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("order 1: expected order 0"));
  }
}

}  // namespace textonbench::model_file_test
