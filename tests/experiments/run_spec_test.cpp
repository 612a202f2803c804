#include "experiments/run_spec.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "experiments/provenance.h"

namespace textonbench::run_spec_test {

using testing::HasSubstr;
using Json = nlohmann::ordered_json;

RunSpec example() {
  return {.method = "rpn",
          .params = {{"component", "periodic"}, {"flag", true}, {"order", std::int64_t{3}}, {"step", 0.1}},
          .exemplar = "mamurk_a_1",
          .exemplar_sha256 = std::string(64, 'a'),
          .size = {640, 480},
          .periodic = true,
          .seed = 18446744073709551615U,
          .samples = 4,
          .metrics = {"rme", "skewness"},
          .pictures = {"sample"}};
}

std::string message_for(const Json& json) {
  try {
    run_spec_from_json(json);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

TEST(RunSpecTest, JsonHasAFixedOrderOfKeys) {
  EXPECT_EQ(to_json(example()).dump(),
            R"({"method":"rpn","params":{"component":"periodic","flag":true,"order":3,"step":0.1},)"
            R"("exemplar":"mamurk_a_1","exemplar_sha256":")" +
                std::string(64, 'a') +
                R"(","size":[640,480],"periodic":true,"seed":18446744073709551615,"samples":4,)"
                R"("metrics":["rme","skewness"],"pictures":["sample"]})");
}

TEST(RunSpecTest, JsonRoundTrips) {
  RunSpec spec = example();
  spec.params["whole"] = 2.0;  // a real number stays one
  spec.params["negative"] = std::int64_t{-1};
  const Json json = Json::parse(to_json(spec).dump());
  const RunSpec back = run_spec_from_json(json);
  EXPECT_EQ(to_json(back).dump(), to_json(spec).dump());
  EXPECT_EQ(back.params, spec.params);
  EXPECT_EQ(run_id(back), run_id(spec));
}

TEST(RunSpecTest, OptionsOfAGraphicsProcessorAreThereWhereItDraws) {
  EXPECT_FALSE(to_json(example()).contains("gpu"));
  RunSpec spec = example();
  spec.gpu = {{"path", "compute"}, {"pitch", 20.0}, {"half", false}, {"supersampling", std::int64_t{1}}};
  const Json json = to_json(spec);
  EXPECT_EQ(json["gpu"].dump(), R"({"half":false,"path":"compute","pitch":20.0,"supersampling":1})");
  const RunSpec back = run_spec_from_json(json);
  EXPECT_EQ(back.gpu, spec.gpu);
  EXPECT_EQ(run_id(back), run_id(spec));
  EXPECT_THAT(command_line(spec),
              HasSubstr(" --gpu half=false --gpu path=compute --gpu pitch=20 --gpu supersampling=1 "));
  const std::map<std::string, ParamValue> options = options_of(spec);
  EXPECT_EQ(options.at("gpu.path"), ParamValue("compute"));
  EXPECT_EQ(options.at("order"), ParamValue(std::int64_t{3}));
  Json wrong = json;
  wrong["gpu"]["path"] = Json::array();
  EXPECT_THAT(message_for(wrong), HasSubstr("gpu.path: expected"));
}

TEST(RunSpecTest, OnlyWhatAGraphicsProcessorDrawsDependsOnItsSources) {
  const std::vector<std::string> metrics{"rme"};
  EXPECT_NE(code_version("texton_noise", metrics, true), code_version("texton_noise", metrics, false));
  EXPECT_EQ(code_version("texton_noise", metrics, false), code_version("texton_noise", metrics, false));
}

TEST(RunSpecTest, NamesTheBadKey) {
  const Json good = to_json(example());
  EXPECT_EQ(message_for(good), "no error");
  for (const auto& [key, value] : good.items()) {
    Json lacking = good;
    lacking.erase(key);
    EXPECT_THAT(message_for(lacking), HasSubstr("lacks the key \"" + key + "\""));
    Json wrong = good;
    wrong[key] = nullptr;
    EXPECT_THAT(message_for(wrong), HasSubstr(key + ": expected")) << key;
  }
  const auto changed = [&](const std::string& key, const Json& value) {
    Json json = good;
    json[key] = value;
    return message_for(json);
  };
  EXPECT_THAT(changed("samples", 0), HasSubstr("samples: expected a whole number from 1 to 2147483647, found 0"));
  EXPECT_THAT(changed("samples", 5000000000), HasSubstr("samples"));
  EXPECT_THAT(changed("seed", -1), HasSubstr("seed"));
  EXPECT_THAT(changed("size", {1, 2, 3}), HasSubstr("size: expected [width, height]"));
  EXPECT_THAT(changed("size", {-1, 2}), HasSubstr("size"));
  EXPECT_THAT(changed("metrics", {"rme", 3}), HasSubstr("metrics: expected a list of strings"));
  EXPECT_THAT(changed("params", {{"order", Json::array()}}), HasSubstr("params.order"));
  EXPECT_THAT(changed("sampels", 3), HasSubstr("unknown key \"sampels\" (did you mean \"samples\"?)"));
  EXPECT_THAT(message_for(Json::array()), HasSubstr("expected a JSON object"));
}

TEST(RunSpecTest, TheIdHashesSpecAndCode) {
  const RunSpec spec = example();
  EXPECT_EQ(run_id(spec), sha256(to_json(spec).dump() + "\ncode " + code_version(spec)).substr(0, 16));
  EXPECT_EQ(run_id(spec).find_first_not_of("0123456789abcdef"), std::string::npos);
}

TEST(RunSpecTest, TheIdChangesWithEveryFieldButTheTimeout) {
  const std::vector<std::function<void(RunSpec&)>> changes{
      [](RunSpec& s) { s.method = "adsn"; },
      [](RunSpec& s) { s.params["order"] = std::int64_t{4}; },
      [](RunSpec& s) { s.params["order"] = 3.0; },
      [](RunSpec& s) { s.exemplar = "ring"; },
      [](RunSpec& s) { s.exemplar_sha256[0] = 'b'; },
      [](RunSpec& s) { s.size.width = 641; },
      [](RunSpec& s) { s.periodic = false; },
      [](RunSpec& s) { s.seed = 1; },
      [](RunSpec& s) { s.samples = 5; },
      [](RunSpec& s) { s.metrics.pop_back(); },
      [](RunSpec& s) { s.pictures.clear(); },
      [](RunSpec& s) { s.gpu["path"] = "fragment"; },
      [](RunSpec& s) { s.gpu["path"] = "compute"; },
  };
  std::set<std::string> ids{run_id(example())};
  for (const auto& change : changes) {
    RunSpec spec = example();
    change(spec);
    ids.insert(run_id(spec));
  }
  EXPECT_EQ(ids.size(), changes.size() + 1);
  RunSpec patient = example();
  patient.timeout_seconds = 1e6;
  EXPECT_EQ(run_id(patient), run_id(example()));
}

TEST(RunSpecTest, CommandLineIsSafeInAShell) {
  RunSpec spec = example();
  EXPECT_EQ(command_line(spec),
            "textonbench measure rpn mamurk_a_1 -p component=periodic -p flag=true -p order=3 -p step=0.1 "
            "--size 640x480 --periodic --seed 18446744073709551615 --samples 4");
  spec.params = {{"label", "two words; $(rm) 'x'"}};
  spec.exemplar = "my grass";
  spec.size = {};
  spec.periodic = false;
  spec.seed = 1;
  EXPECT_EQ(command_line(spec),
            "textonbench measure rpn 'my grass' -p 'label=two words; $(rm) '\\''x'\\''' --no-periodic --seed 1 "
            "--samples 4");
}

}  // namespace textonbench::run_spec_test
