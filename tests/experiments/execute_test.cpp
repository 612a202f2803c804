#include "experiments/execute.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "experiments/conditional_pictures.h"
#include "experiments/lrp_pictures.h"
#include "experiments/metrics/metric.h"
#include "experiments/pictures.h"
#include "experiments/provenance.h"
#include "methods/base/image_io.h"
#include "tests/temporary_folder.h"

namespace textonbench::execute_test {

using testing::ElementsAre;
using testing::HasSubstr;

class ExecuteTest : public testing::Test {
 protected:
  RunSpec make_spec(const std::string& method) const {
    RunSpec spec;
    spec.method = method;
    spec.params = Params(find_method(method).params, {}).values();
    spec.exemplar = "white_noise";
    spec.exemplar_sha256 = exemplar_sha256(exemplars_.find("white_noise"));
    spec.samples = 2;
    return spec;
  }
  Record execute_here(const RunSpec& spec) const { return execute(spec, exemplars_, &results_); }

  TemporaryFolder folder_;
  ResultsFolder results_{folder_.path()};
  ExemplarCatalog exemplars_{TEXTONBENCH_SOURCE_DIR};
};

TEST_F(ExecuteTest, ARecordHasAllItsKeysInOrder) {
  RunSpec spec = make_spec("rpn");
  spec.metrics = {"mean_error"};
  spec.pictures = {"sample"};
  const Record record = execute_here(spec);
  std::vector<std::string> keys;
  for (const auto& [key, value] : record.items()) keys.push_back(key);
  EXPECT_THAT(keys, ElementsAre("schema", "id", "status", "spec", "command", "exemplar", "metrics", "pictures", "time",
                                "provenance"));
  EXPECT_EQ(record["status"], "ok");
  EXPECT_EQ(record["id"], run_id(spec));
  EXPECT_EQ(run_id(run_spec_from_json(Record::parse(record["spec"].dump()))), run_id(spec));
  EXPECT_EQ(record["exemplar"]["channels"], 3);
  EXPECT_GT(record["time"]["wall_seconds"].get<double>(), 0);
  EXPECT_GT(record["time"]["cpu_seconds"].get<double>(), 0);
  EXPECT_GT(record["time"]["peak_bytes"].get<double>(), 1e6);
  EXPECT_THAT(record["time"]["finished"].get<std::string>(),
              testing::MatchesRegex("[0-9]{4}-[0-9]{2}-[0-9]{2}T[0-9]{2}:[0-9]{2}:[0-9]{2}Z"));
}

TEST_F(ExecuteTest, EveryMetricIsMeasuredWithWhatItsLevelPromises) {
  RunSpec spec = make_spec("adsn");
  for (const MetricEntry& metric : metric_catalog()) {
    if (metric.level != MetricLevel::frame) spec.metrics.emplace_back(metric.name);
  }
  const Record record = execute_here(spec);
  for (const std::string& name : spec.metrics) {
    const MetricEntry& metric = find_metric(name);
    constexpr std::array sources{"texton_quality", "spot_identities", "kurtosis_slope",    "torus_crop",
                                 "window_cost",    "reference_error", "spline_smoothness", "surface_identities",
                                 "point_cost",     "kriging_metrics", "conditional_law",   "lrp_identities",
                                 "lrp_structure",  "lrp_estimates",   "gabor_metrics"};
    constexpr std::array names{"shifted_covariance_deviation", "subpixel_covariance_deviation",
                               "signed_mean_deviation",        "signed_covariance_deviation",
                               "kept_channel_variance",        "cells_visited",
                               "impacts_drawn_ratio",          "fetches_per_pixel"};
    const bool of_textons = std::ranges::find(sources, metric.source) != sources.end() ||
                            std::ranges::find(names, metric.name) != names.end() || metric.of_limit != nullptr;
    ASSERT_EQ(record["metrics"].contains(metric.name), !of_textons) << metric.name;
    if (of_textons) continue;
    const Record& value = record["metrics"][std::string(metric.name)];
    EXPECT_TRUE(value["value"].is_number()) << metric.name;
    EXPECT_EQ(value["unit"], metric.unit);
    const bool sampled = metric.level == MetricLevel::sample;
    EXPECT_EQ(value["stderr"].is_number(), sampled) << metric.name;
    EXPECT_EQ(value["floor"].is_number(), sampled) << metric.name;
  }
  const Record& metrics = record["metrics"];
  EXPECT_GT(metrics["analyze_seconds"]["value"].get<double>(), 0);
  EXPECT_NEAR(metrics["ns_per_pixel"]["value"].get<double>(),
              1e9 * metrics["synthesize_seconds"]["value"].get<double>() / (256 * 256), 1e-9);
}

TEST_F(ExecuteTest, NumbersDependOnTheSeedAlone) {
  RunSpec spec = make_spec("adsn");
  spec.metrics = {"mean_error", "patch_distance"};
  const Record first = execute_here(spec), again = execute_here(spec);
  EXPECT_EQ(first["metrics"], again["metrics"]);
  spec.seed = 2;
  EXPECT_NE(execute_here(spec)["metrics"], first["metrics"]);
}

TEST_F(ExecuteTest, TheFloorIsDrawnApartFromTheSamples) {
  RunSpec spec = make_spec("adsn");
  spec.metrics = {"mean_error"};
  const Record adsn = execute_here(spec)["metrics"]["mean_error"];
  EXPECT_NE(adsn["value"], adsn["floor"]);
  spec = make_spec("rpn");
  spec.metrics = {"mean_error"};
  EXPECT_EQ(execute_here(spec)["metrics"]["mean_error"]["floor"], adsn["floor"]) << "the same floor for every method";
}

TEST_F(ExecuteTest, AWindowOfThePlaneIsHeldAgainstTheSameWindow) {
  RunSpec spec = make_spec("adsn");
  spec.size = {96, 64};
  spec.periodic = false;
  spec.metrics = {"mean_error"};
  spec.pictures = {"sample"};
  const Record record = execute_here(spec);
  EXPECT_EQ(record["pictures"]["sample"]["width"], 96);
  EXPECT_EQ(record["pictures"]["sample"]["height"], 64);
  EXPECT_TRUE(record["metrics"]["mean_error"]["floor"].is_number());
}

bool of_missing_pixels(std::string_view picture) {
  const auto pictures = conditional_pictures();
  return std::ranges::find(pictures, picture, &PictureEntry::name) != pictures.end();
}

TEST_F(ExecuteTest, EveryPictureOfMissingPixelsIsKept) {
  RunSpec spec = make_spec("inpainting");
  spec.periodic = false;
  spec.metrics = {"kriging_residual"};
  for (const PictureEntry& picture : conditional_pictures()) spec.pictures.emplace_back(picture.name);
  const Record record = execute_here(spec);
  ASSERT_EQ(record["status"], "ok") << record.dump();
  EXPECT_LT(record["metrics"]["kriging_residual"]["value"].get<double>(), 1.1e-6);
  for (const std::string& name : spec.pictures) {
    const Extent extent = read_image_info(folder_.path() / record["pictures"][name]["file"].get<std::string>()).extent;
    // A tenth of 256 x 256 is a square of 81 x 81; the close-up has 40 more on every side.
    EXPECT_EQ(extent, name == "hole" ? (Extent{161, 161}) : (Extent{256, 256})) << name;
  }
}

TEST_F(ExecuteTest, APictureOfMissingPixelsNeedsAMethodThatHasSome) {
  RunSpec spec = make_spec("adsn");
  spec.pictures = {"masked"};
  EXPECT_THAT([&] { execute_here(spec); },
              testing::ThrowsMessage<std::invalid_argument>(testing::HasSubstr("expected inpainting")));
}

TEST_F(ExecuteTest, EveryPictureOfStrataAndWindowsIsKept) {
  RunSpec spec = make_spec("lrp");
  spec.periodic = false;
  spec.params["structure"] = 0.2;
  for (const PictureEntry& picture : lrp_pictures()) spec.pictures.emplace_back(picture.name);
  const Record record = execute_here(spec);
  ASSERT_EQ(record["status"], "ok") << record.dump();
  for (const std::string& name : spec.pictures) {
    const Extent extent = read_image_info(folder_.path() / record["pictures"][name]["file"].get<std::string>()).extent;
    // Samples of layers; the rest is of the blocks of 128 x 128 that a picture of 256 x 256 has.
    EXPECT_EQ(extent, name.starts_with("lrp_layer") ? (Extent{256, 256}) : (Extent{128, 128})) << name;
  }
}

TEST_F(ExecuteTest, EveryPictureOfTheCatalogIsKept) {
  RunSpec spec = make_spec("sot");
  spec.samples = 3;
  for (const PictureEntry& picture : picture_catalog()) {
    if (!of_missing_pixels(picture.name) && !picture.name.starts_with("lrp_")) spec.pictures.emplace_back(picture.name);
  }
  const Record record = execute_here(spec);
  for (const std::string& name : spec.pictures) {
    const Record& picture = record["pictures"][name];
    const ImageInfo info = read_image_info(folder_.path() / picture["file"].get<std::string>());
    EXPECT_EQ(info.extent, (Extent{picture["width"], picture["height"]})) << name;
    EXPECT_EQ(info.channels, 3) << name;
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path() / "pictures")) {
    EXPECT_EQ(entry.path().stem().string().size(), 64U) << "a draft is left behind: " << entry.path();
  }
}

TEST_F(ExecuteTest, TheSamplePictureIsTheSampleOfThatSeed) {
  RunSpec spec = make_spec("rpn");
  spec.pictures = {"sample_2"};
  const Record record = execute_here(spec);
  const Exemplar exemplar = load_exemplar(exemplars_.find("white_noise"));
  const MethodEntry& rpn = find_method("rpn");
  const std::unique_ptr<Model> model = rpn.analyze({exemplar}, Params(rpn.params, {}), analysis_seed(1));
  const Image sample =
      model->synthesize({.size = exemplar.pixels.extent(), .periodic = true}, sample_seed(1, /*index=*/1));
  write_image(sample, folder_.path() / "expected.png");
  EXPECT_EQ(record["pictures"]["sample_2"]["file"],
            "pictures/" + sha256_of_file(folder_.path() / "expected.png") + ".png");
}

TEST_F(ExecuteTest, ARefusalIsARecordWithItsReason) {
  RunSpec spec = make_spec("rpn");
  spec.periodic = false;
  spec.metrics = {"mean_error"};
  const Record record = execute_here(spec);
  EXPECT_EQ(record["status"], "refused");
  EXPECT_FALSE(record["reason"].get<std::string>().empty());
  EXPECT_TRUE(record["metrics"].empty());
  EXPECT_EQ(record["exemplar"]["width"], 256);
}

TEST_F(ExecuteTest, AnotherExemplarThanPlannedIsAnError) {
  RunSpec spec = make_spec("rpn");
  spec.exemplar_sha256 = std::string(64, '0');
  try {
    execute_here(spec);
    FAIL() << "expected an exception";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), testing::AllOf(HasSubstr("white_noise"), HasSubstr(spec.exemplar_sha256)));
  }
}

TEST_F(ExecuteTest, APictureOfASampleThatIsNotDrawnIsAnError) {
  RunSpec spec = make_spec("rpn");
  spec.pictures = {"sample_3"};
  EXPECT_THROW(execute_here(spec), std::invalid_argument);
}

TEST_F(ExecuteTest, AnUnsuccessfulRecordHasTheSameKeys) {
  const RunSpec spec = make_spec("rpn");
  const Record failed = unsuccessful_record(spec, "failed", "killed by SIGKILL");
  EXPECT_EQ(failed["reason"], "killed by SIGKILL");
  const Record succeeded = execute_here(spec);
  for (const auto& [key, value] : succeeded.items()) {
    EXPECT_TRUE(failed.contains(key)) << key;
  }
}

TEST(FindPictureTest, SuggestsTheNearestName) {
  try {
    find_picture("exemplar_modulous");
    FAIL() << "expected an exception";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("did you mean \"exemplar_modulus\"?"));
  }
}

}  // namespace textonbench::execute_test
