#include "experiments/exemplar_stack.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "experiments/conditional_pictures.h"
#include "experiments/execute.h"
#include "experiments/metrics/metric.h"
#include "experiments/pictures.h"
#include "tests/experiments/exemplar_home.h"

namespace textonbench::exemplar_stack_test {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

class ExemplarStackTest : public testing::Test {
 protected:
  ExemplarCatalog catalog() const { return ExemplarCatalog(home_.path()); }
  std::string write(const std::string& name, int channels, Extent extent = {24, 16}) const {
    const std::filesystem::path file = home_.path() / name;
    write_image(test_texture(extent, channels, 3), file);
    return file.string();
  }
  Exemplar load(const std::string& names) const { return load_exemplar(find_exemplar(catalog(), names)); }
  void expect_refused(const std::string& names, const testing::Matcher<std::string>& message) const {
    EXPECT_THAT([&] { load(names); }, ThrowsMessage<std::invalid_argument>(message)) << names;
  }
  /// A second table [[exemplar]] named "moss" with these lines.
  void add_stack(const std::string& lines) const {
    std::ofstream(home_.catalog(), std::ios::app) << "\n[[exemplar]]\nname = \"moss\"\n" << lines << "\n";
  }

  const ExemplarHome home_;
  const DataVariable data_{home_.data()};
};

TEST_F(ExemplarStackTest, MapsStandInOrder) {
  const std::string height = write("height.exr", 1);
  const Exemplar stack = load("grass+" + height);
  EXPECT_EQ(stack.name, "grass+height");
  EXPECT_THAT(stack.maps, ElementsAre(ImageMap{"grass", 3}, ImageMap{"height", 1}));
  ASSERT_EQ(stack.pixels.channels(), 4);
  const Image color = load("grass").pixels;
  const Image gray = load(height).pixels;
  for (int y = 0; y < 16; ++y) {
    EXPECT_TRUE(std::ranges::equal(stack.pixels.row(2, y), color.row(2, y)));
    EXPECT_TRUE(std::ranges::equal(stack.pixels.row(3, y), gray.row(0, y)));
  }
  EXPECT_NO_THROW(require_usable(stack));
  EXPECT_EQ(stack.sha256, exemplar_sha256(find_exemplar(catalog(), "grass+" + height)));
  EXPECT_NE(stack.sha256, load(height + "+grass").sha256);
  EXPECT_TRUE(load("grass").maps.empty());
}

TEST_F(ExemplarStackTest, AStackOfOneFileGivesItsOwnMaps) {
  const std::filesystem::path file = home_.path() / "all.exr";
  const std::vector<ImageMap> maps{{"albedo", 3}, {"height", 1}};
  write_image(test_texture({24, 16}, 4), file, maps);
  EXPECT_EQ(load(file.string()).maps, maps);
  EXPECT_THAT(load(file.string() + "+grass").maps, ElementsAre(maps[0], maps[1], ImageMap{"grass", 3}));
}

TEST_F(ExemplarStackTest, AFileMayHaveThePlusInItsName) {
  const std::string file = write("a+b.png", 1);
  EXPECT_EQ(load(file).name, "a+b");
  EXPECT_TRUE(load(file).maps.empty());
}

TEST_F(ExemplarStackTest, UnusableStacksAreRefused) {
  const std::string height = write("height.exr", 1);
  const std::string large = write("large.png", 1, {30, 20});
  const std::string normal = write("normal.png", 3);
  const std::string metal = write("metal.png", 3);
  expect_refused(height + "+" + large, AllOf(HasSubstr(height + " has 24x16 pixels and " + large + " has 30x20")));
  expect_refused("grass+" + normal + "+" + metal,
                 HasSubstr("\"grass+normal+metal\" has 9 channels in 3 maps: expected at most 8"));
  expect_refused("grass+" + height + "+grass", HasSubstr("two maps named \"grass\""));
  expect_refused("grass+", HasSubstr("\"grass+\": expected names or files of maps on both sides of \"+\""));
  expect_refused("grass+gras", HasSubstr("unknown exemplar \"gras\" (did you mean \"grass\"?)"));
  expect_refused("grass+sand", HasSubstr("apt-get install beach-data"));
}

TEST_F(ExemplarStackTest, TheCatalogNamesStacks) {
  write("installed/moss_height.png", 1);
  add_stack("package = \"meadow-data\"\nfiles = [\"green.png\", \"moss_height.png\"]\ntags = [\"stack\"]");
  const ExemplarCatalog all = catalog();
  EXPECT_TRUE(all.find("moss").available);
  EXPECT_THAT(all.tagged("stack"), ElementsAre("moss", "color_and_height"));
  const Exemplar moss = load_exemplar(all.find("moss"));
  EXPECT_EQ(moss.name, "moss");
  EXPECT_THAT(moss.maps, ElementsAre(ImageMap{"green", 3}, ImageMap{"moss_height", 1}));
}

TEST_F(ExemplarStackTest, AMapThatIsMissingOrAnotherIsTold) {
  const std::string sha = sha256_of_file(home_.grass());
  add_stack("package = \"meadow-data\"\nfiles = [\"green.png\", \"moss_height.png\"]\nsha256 = [\"" + sha + "\", \"" +
            sha + "\"]");
  expect_refused("moss", HasSubstr("\"moss\" is not available here: map moss_height: apt-get install meadow-data"));
  EXPECT_TRUE(catalog().look_up("moss").file.empty());
  ExemplarHome::write_picture(home_.data() / "moss_height.png", 9);
  expect_refused("moss", HasSubstr("moss_height.png is another picture"));
  std::filesystem::copy(home_.grass(), home_.data() / "moss_height.png",
                        std::filesystem::copy_options::overwrite_existing);
  EXPECT_EQ(load("moss").pixels.channels(), 6);
  ExemplarHome::write_picture(home_.data() / "moss.png", 9);
  expect_refused("moss", HasSubstr("moss.png has the name of a stack of maps: rename it"));
}

TEST_F(ExemplarStackTest, ABadStackOfTheCatalogIsToldWithItsPlace) {
  const auto message = [&](const std::string& lines) {
    home_.write_catalog("[[package]]\nname = \"p\"\nsource = \"s\"\nlicence = \"l\"\nhow_to_get = \"h\"\n");
    add_stack("package = \"p\"\n" + lines);
    try {
      catalog();
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_THAT(message("files = [\"a.png\"]"), HasSubstr("10:9: files: expected the files of at least two maps"));
  EXPECT_THAT(message("files = [\"a.png\", \"b.png\"]\nsha256 = [\"00\"]"), HasSubstr("11:10: sha256: expected 2"));
  EXPECT_THAT(message("files = [\"a.png\", \"b.png\"]\nfile = \"a.png\""), HasSubstr("unknown key \"file\""));
}

/// Every metric has a value of a stack or none of the method, and every picture shows all maps side by side.
TEST(ExecuteStackTest, MetricsAndPicturesServeStacks) {
  const TemporaryFolder folder;
  const ResultsFolder results(folder.path());
  const ExemplarCatalog exemplars(TEXTONBENCH_SOURCE_DIR);
  for (const char* method : {"texton_noise", "sot"}) {
    RunSpec spec;
    spec.method = method;
    spec.params = Params(find_method(method).params, {{"support", std::int64_t{9}}}).values();
    spec.exemplar = "color_and_height";
    spec.exemplar_sha256 = exemplar_sha256(exemplars.find(spec.exemplar));
    spec.samples = 2;
    spec.size = {96, 80};
    spec.periodic = false;
    for (const MetricEntry& metric : metric_catalog()) {
      if (!metric.identity && metric.level != MetricLevel::frame) spec.metrics.emplace_back(metric.name);
    }
    for (const PictureEntry& picture : picture_catalog()) {
      const auto missing = conditional_pictures();
      if (picture.name == "sample_3" || picture.name.starts_with("lrp_") ||
          std::ranges::find(missing, picture.name, &PictureEntry::name) != missing.end()) {
        continue;
      }
      spec.pictures.emplace_back(picture.name);
    }
    const Record record = execute(spec, exemplars, &results);
    ASSERT_EQ(record["status"], "ok") << record.dump();
    EXPECT_EQ(record["exemplar"]["channels"], 4);
    for (const char* metric : {"rme", "color_covariance_error", "patch_distance", "excess_kurtosis", "mean_error",
                               "autocovariance_error_32", "log_spectral_distance", "cramer_von_mises"}) {
      ASSERT_TRUE(record["metrics"].contains(metric)) << method << ' ' << metric;
      EXPECT_TRUE(record["metrics"][metric]["value"].is_number()) << method << ' ' << metric;
    }
    EXPECT_EQ(record["pictures"]["sample"]["width"], 2 * 96 + 2);
    EXPECT_EQ(record["pictures"]["exemplar"]["width"], 2 * 256 + 2);
  }
}

}  // namespace textonbench::exemplar_stack_test
