#include "experiments/plan.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <set>

#include "experiments/metrics/metric.h"
#include "experiments/provenance.h"
#include "tests/experiments/exemplar_home.h"

namespace textonbench::plan_test {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

class PlanTest : public testing::Test {
 protected:
  Plan plan(const std::string& tables, std::size_t most_runs = 20000) const {
    const std::filesystem::path file = home_.path() / "c.toml";
    std::ofstream(file) << "title = \"T\"\nsource = \"S\"\n" << tables;
    return make_plan(read_config(file, Profile::quick), ExemplarCatalog(home_.path()), most_runs);
  }

  /// One table, whose first three keys stand in lines 3 to 5, and line 6 on.
  Plan plan_table(const std::string& rest, std::size_t most_runs = 20000) const {
    return plan("[[runs]]\nname = \"a\"\n" + rest + "\n", most_runs);
  }

  template <class Call>
  std::string error_of(const Call& call) const {
    try {
      call();
    } catch (const ConfigError& error) {
      const std::string file = (home_.path() / "c.toml").string() + ":";
      EXPECT_THAT(error.what(), StartsWith(file));
      return std::string(error.what()).substr(file.size());
    }
    ADD_FAILURE() << "no ConfigError";
    return "";
  }
  std::string table_error(const std::string& rest, std::size_t most_runs = 20000) const {
    return error_of([&] { plan_table(rest, most_runs); });
  }

  const ExemplarHome home_;
  const DataVariable data_{home_.data()};
  const std::string rpn_ = "method = \"rpn\"\nexemplars = \"ring\"\n";  // lines 5 and 6
};

std::vector<std::string> describe(const Plan& plan) {
  std::vector<std::string> lines;
  for (const PlannedRun& run : plan.runs) {
    lines.push_back(fmt::format("{} {} {} {}", run.spec.method, run.spec.exemplar,
                                to_string(run.spec.params.at("component")), run.spec.seed));
  }
  return lines;
}

TEST_F(PlanTest, AGridIsTheProductOfItsListsInOrder) {
  const Plan p = plan_table(
      "method = [\"rpn\", \"adsn\"]\nexemplars = [\"ring\", \"grass\"]\nseeds = [1, 2]\nparams.component = [\"raw\"]");
  EXPECT_THAT(describe(p), ElementsAre("rpn ring raw 1", "rpn ring raw 2", "rpn grass raw 1", "rpn grass raw 2",
                                       "adsn ring raw 1", "adsn ring raw 2", "adsn grass raw 1", "adsn grass raw 2"));
  EXPECT_THAT(p.missing, IsEmpty());
  EXPECT_THAT(p.by_label.at("a"), ElementsAre(0, 1, 2, 3, 4, 5, 6, 7));
}

TEST_F(PlanTest, ARunIsComplete) {
  const Plan p = plan_table(
      rpn_ +
      "seeds = 7\nsize = [300, 200]\nperiodic = false\nsamples = 3\ntimeout_seconds = 9\nmemory_limit_mb = 512\n"
      "metrics = [\"skewness\", \"rme\", \"rme\"]\npictures = [\"sample\", \"exemplar\"]");
  ASSERT_EQ(p.runs.size(), 1U);
  const PlannedRun& run = p.runs[0];
  EXPECT_EQ(run.label, "a");
  EXPECT_EQ(run.id, run_id(run.spec));
  EXPECT_EQ(run.spec.params, Params(find_method("rpn").params, {}).values());
  EXPECT_EQ(run.spec.exemplar_sha256, exemplar_sha256(ExemplarCatalog(home_.path()).find("ring")));
  EXPECT_EQ(run.spec.size, (Extent{300, 200}));
  EXPECT_FALSE(run.spec.periodic);
  EXPECT_EQ(run.spec.seed, 7U);
  EXPECT_EQ(run.spec.samples, 3);
  EXPECT_EQ(run.spec.timeout_seconds, 9);
  EXPECT_EQ(run.spec.memory_limit_mb, 512);
  EXPECT_THAT(run.spec.metrics, ElementsAre("rme", "skewness"));
  EXPECT_THAT(run.spec.pictures, ElementsAre("exemplar", "sample"));
}

TEST_F(PlanTest, AZipAdvancesItsListsTogether) {
  const Plan p = plan_table(
      "method = \"rpn\"\nexemplars = [\"ring\", \"grass\", \"ring\"]\nseeds = [1, 2, 3]\ncombine = \"zip\"\n"
      "params.component = [\"raw\", \"raw\", \"periodic\"]");
  EXPECT_THAT(describe(p), ElementsAre("rpn ring raw 1", "rpn grass raw 2", "rpn ring periodic 3"));
}

TEST_F(PlanTest, AZipOfDifferentLengthsIsRefused) {
  EXPECT_THAT(table_error("method = \"rpn\"\nexemplars = [\"ring\", \"grass\"]\nseeds = [1, 2, 3]\ncombine = \"zip\""),
              AllOf(StartsWith("6:13: "), HasSubstr("exemplars has 2 values where seeds has 3")));
}

TEST_F(PlanTest, AnAblationChangesOneParameterAtATime) {
  const Plan p = plan_table(
      "method = \"rpn\"\nexemplars = [\"ring\", \"grass\"]\nseeds = [1, 2]\ncombine = \"ablate\"\n"
      "params.component = [\"raw\", \"periodic\"]\nparams.phase = [\"added\", \"replaced\"]");
  std::vector<std::string> runs;
  for (const PlannedRun& run : p.runs) {
    runs.push_back(run.spec.exemplar + " " + to_string(run.spec.params.at("component")) + " " +
                   to_string(run.spec.params.at("phase")) + " " + std::to_string(run.spec.seed));
  }
  EXPECT_THAT(runs, ElementsAre("ring raw added 1", "ring raw added 2", "ring periodic added 1",
                                "ring periodic added 2", "ring raw replaced 1", "ring raw replaced 2",
                                "grass raw added 1", "grass raw added 2", "grass periodic added 1",
                                "grass periodic added 2", "grass raw replaced 1", "grass raw replaced 2"));
}

TEST_F(PlanTest, AnAblationPassesOverParametersOfOneValue) {
  const Plan p = plan_table(rpn_ +
                            "combine = \"ablate\"\nparams.component = \"raw\"\n"
                            "params.phase = [\"replaced\", \"added\"]\nexclude = [{phase = \"replaced\"}]");
  ASSERT_EQ(p.runs.size(), 1U);
  EXPECT_EQ(to_string(p.runs[0].spec.params.at("component")), "raw");
  EXPECT_EQ(to_string(p.runs[0].spec.params.at("phase")), "added");
}

TEST_F(PlanTest, AnAblationWithoutAListOfParametersIsRefused) {
  EXPECT_THAT(table_error(rpn_ + "seeds = [1, 2]\ncombine = \"ablate\"\nparams.component = \"raw\""),
              AllOf(StartsWith("8:11: "), HasSubstr("expected a parameter with at least two values")));
}

TEST_F(PlanTest, ExcludeTakesAwayWhatMatchesAllItsKeys) {
  const Plan p = plan_table(
      "method = [\"rpn\", \"adsn\"]\nexemplars = [\"ring\", \"grass\"]\nseeds = [1, 2]\n"
      "exclude = [{method = \"rpn\", exemplar = \"ring\"}, {seed = 2, phase = \"added\"}, {method = \"adsn\", seed = "
      "1}]");
  EXPECT_THAT(describe(p), ElementsAre("rpn grass periodic 1", "adsn ring periodic 2", "adsn grass periodic 2"));
}

TEST_F(PlanTest, ExcludeThatLeavesNothingIsAnEmptySweep) {
  EXPECT_THAT(table_error(rpn_ + "exclude = [{method = \"rpn\"}]"),
              AllOf(StartsWith("7:11: "), HasSubstr("empty sweep")));
}

TEST_F(PlanTest, BadExcludeKeysAndValuesAreToldWithTheirPlace) {
  EXPECT_THAT(table_error(rpn_ + "exclude = [{exemplr = \"ring\"}]"),
              AllOf(StartsWith("7:13: unknown key \"exemplr\" in exclude (did you mean \"exemplar\"?)"),
                    HasSubstr("method, exemplar, seed, component, phase")));
  EXPECT_THAT(table_error(rpn_ + "exclude = [{exemplar = \"rnig\"}]"),
              AllOf(StartsWith("7:24: "), HasSubstr("did you mean \"ring\"")));
  EXPECT_THAT(table_error(rpn_ + "exclude = [{method = \"rpm\"}]"), AllOf(StartsWith("7:22: "), HasSubstr("rpn")));
  EXPECT_THAT(table_error(rpn_ + "exclude = [{seed = \"one\"}]"), AllOf(StartsWith("7:20: "), HasSubstr("seed")));
  EXPECT_THAT(table_error(rpn_ + "exclude = [{component = \"rw\"}]"),
              AllOf(StartsWith("7:25: "), HasSubstr("did you mean \"raw\"")));
}

TEST_F(PlanTest, DuplicatesAreRemovedAndTablesShareRuns) {
  const Plan p = plan(
      "[[runs]]\nname = \"a\"\nmethod = \"rpn\"\nexemplars = [\"@procedural\", \"ring\"]\nseeds = [1, 1]\n"
      "[[runs]]\nname = \"b\"\nmethod = [\"adsn\", \"rpn\"]\nexemplars = \"ring\"\nparams.component = \"periodic\"\n");
  EXPECT_THAT(describe(p),
              ElementsAre("rpn white_noise periodic 1", "rpn ring periodic 1", "rpn oriented_lobe periodic 1",
                          "rpn power_law periodic 1", "adsn ring periodic 1"));
  EXPECT_THAT(p.by_label.at("a"), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(p.by_label.at("b"), ElementsAre(1, 4));
}

TEST_F(PlanTest, ExemplarsThatAreNotHereAreToldAndLeftOut) {
  const Plan p = plan_table("method = \"rpn\"\nexemplars = [\"@default\", \"paper\"]\nseeds = [1, 2, 3]");
  EXPECT_EQ(p.runs.size(), 15U);  // grass and four procedural ones
  ASSERT_EQ(p.missing.size(), 2U);
  EXPECT_EQ(p.missing[0].name, "sand");
  EXPECT_EQ(p.missing[0].how_to_get, "apt-get install beach-data");
  EXPECT_EQ(p.missing[0].runs, 3U);
  EXPECT_EQ(p.missing[1].name, "paper");
  EXPECT_EQ(p.missing[1].runs, 3U);
}

TEST_F(PlanTest, AWrongPictureUnderAKnownNameIsAnError) {
  ExemplarHome::write_picture(home_.data() / "paper.png", 7);
  EXPECT_THAT(table_error("method = \"rpn\"\nexemplars = [\"ring\", \"@paper\"]"),
              AllOf(StartsWith("6:22: "), HasSubstr("is another picture"), HasSubstr("rename or remove it")));
}

TEST_F(PlanTest, SamplesOffTheExemplarsPixelsAreNotComparedWithIt) {
  const std::string table = rpn_ + "periodic = false\nstep = 0.05\n";
  EXPECT_EQ(plan_table(table + "metrics = [\"rme\"]").runs.at(0).spec.step, 0.05);
  try {
    plan_table(table + "metrics = [\"rme\", \"skewness\"]");
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("step = 0.05: skewness compares pixels"));
  }
  EXPECT_THROW(plan_table(rpn_ + "step = 0"), ConfigError);
}

TEST_F(PlanTest, GroupsOfMetricsStandForTheirLevel) {
  const auto metrics = [&](const std::string& list) {
    return plan_table(rpn_ + "metrics = " + list).runs.at(0).spec.metrics;
  };
  const auto identities = std::ranges::count(metric_catalog(), true, &MetricEntry::identity);
  EXPECT_EQ(metrics("\"@identity\"").size(), identities);
  const auto of_frames = std::ranges::count(metric_catalog(), MetricLevel::frame, &MetricEntry::level);
  EXPECT_EQ(metrics("\"@all\"").size() + identities + of_frames, metric_catalog().size());
  EXPECT_THAT(metrics("[\"@model\"]"),
              ElementsAre("kept_variance", "kernel_kurtosis", "local_kurtosis_greatest", "local_kurtosis_least",
                          "ot_distance", "poisson_impacts", "predicted_kurtosis", "rme", "rme_corrected", "rme_printed",
                          "smoothed_rme", "stratified_impacts"));
  EXPECT_THAT(metrics("[\"@model\", \"rme\", \"skewness\"]"),
              AllOf(testing::SizeIs(13), Contains("rme"), Contains("skewness")));
  EXPECT_THAT(metrics("\"@sample\""), AllOf(Contains("skewness"), Not(Contains("rme"))));
  EXPECT_THAT(metrics("\"@cost\""), AllOf(Contains("analyze_seconds"), Not(Contains("rme"))));
  EXPECT_THAT(metrics("[]"), IsEmpty());
  EXPECT_THAT(table_error(rpn_ + "metrics = [\"rme\", \"@samples\"]"),
              AllOf(StartsWith("7:19: "), HasSubstr("expected @all, @model, @sample, @cost or @identity")));
}

TEST_F(PlanTest, UnknownNamesAreToldWithPlaceAndNearest) {
  EXPECT_THAT(table_error("method = [\"adsn\", \"rnp\"]\nexemplars = \"ring\""),
              AllOf(StartsWith("5:19: "), HasSubstr("\"rnp\""), HasSubstr("did you mean \"rpn\"")));
  EXPECT_THAT(table_error("method = \"rpn\"\nexemplars = [\"grass\", \"rign\"]"),
              AllOf(StartsWith("6:23: unknown exemplar \"rign\""), HasSubstr("did you mean \"ring\"")));
  EXPECT_THAT(table_error("method = \"rpn\"\nexemplars = \"@defualt\""),
              AllOf(StartsWith("6:13: "), HasSubstr("did you mean \"@default\""), HasSubstr("@paper")));
  EXPECT_THAT(table_error(rpn_ + "metrics = \"skewnes\""),
              AllOf(StartsWith("7:11: "), HasSubstr("did you mean \"skewness\"")));
  EXPECT_THAT(table_error(rpn_ + "pictures = [\"sample\", \"exemplr\"]"),
              AllOf(StartsWith("7:23: "), HasSubstr("did you mean \"exemplar\"")));
}

TEST_F(PlanTest, ParametersAreCheckedAgainstTheMethod) {
  EXPECT_THAT(
      table_error(rpn_ + "params.componnt = \"raw\""),
      AllOf(StartsWith("7:8: method rpn: unknown parameter \"componnt\""), HasSubstr("did you mean \"component\"")));
  EXPECT_THAT(table_error(rpn_ + "params.component = [\"periodic\", \"rwa\"]"),
              AllOf(StartsWith("7:33: "), HasSubstr("did you mean \"raw\"")));
  EXPECT_THAT(table_error(rpn_ + "params.component = 3"), AllOf(StartsWith("7:20: "), HasSubstr("expected one of")));
}

TEST_F(PlanTest, AParameterThatOnlySomeMethodsHaveIsRefused) {
  EXPECT_THAT(table_error("method = [\"rpn\", \"adsn\"]\nexemplars = \"ring\"\nparams.phase = \"added\""),
              AllOf(StartsWith("7:8: method adsn: unknown parameter \"phase\""), HasSubstr("component")));
}

TEST_F(PlanTest, DefaultsAreToldWhereTheyStand) {
  EXPECT_THAT(
      error_of([&] {
        plan("[defaults]\nmetrics = [\"rmse\"]\n[[runs]]\nname = \"a\"\nmethod = \"rpn\"\nexemplars = \"ring\"\n");
      }),
      AllOf(StartsWith("4:12: "), HasSubstr("\"rmse\"")));
}

std::string numbers(int count) {
  std::string list = "[";
  for (int i = 0; i < count; ++i) {
    list += std::to_string(i) + ", ";
  }
  return list + "]";
}

std::string repeated(const std::string& value, int count) {
  std::string list = "[";
  for (int i = 0; i < count; ++i) {
    list += value + ", ";
  }
  return list + "]";
}

TEST_F(PlanTest, ALargeSweepIsRefusedBeforeItIsExpanded) {
  EXPECT_THAT(table_error(rpn_ + "seeds = " + numbers(1000) + "\nsize = " + repeated("[64, 64]", 1000)),
              AllOf(StartsWith("3:1: "), HasSubstr("\"a\""), HasSubstr("1000000 runs"), HasSubstr("20000"),
                    HasSubstr("--yes-large")));
}

TEST_F(PlanTest, ASweepTooLargeToCountIsRefusedToo) {
  // 70000^4 is above 2^64.
  EXPECT_THAT(table_error(rpn_ + "seeds = " + numbers(70000) + "\nperiodic = " + repeated("true", 70000) + "\nsize = " +
                          repeated("[8, 8]", 70000) + "\nparams.component = " + repeated("\"raw\"", 70000)),
              HasSubstr("18446744073709551615 runs"));
}

TEST_F(PlanTest, TheLimitIsTheCallers) {
  EXPECT_EQ(plan_table(rpn_ + "seeds = " + numbers(30), 30).runs.size(), 30U);
  EXPECT_THAT(table_error(rpn_ + "seeds = " + numbers(31), 30), HasSubstr("31 runs"));
}

TEST_F(PlanTest, AHundredThousandRunsHaveIdsOfTheirOwn) {
  const Plan p = plan_table(
      "method = [\"rpn\", \"adsn\"]\nexemplars = [\"@procedural\", \"grass\"]\nmetrics = \"@all\"\nseeds = " +
          numbers(10000),
      100000);
  EXPECT_EQ(p.runs.size(), 100000U);
  std::set<std::string> ids;
  for (const PlannedRun& run : p.runs) ids.insert(run.id);
  EXPECT_EQ(ids.size(), p.runs.size());
}

/// A run's identity comes from the run alone, never from what else is planned.
TEST_F(PlanTest, ChangedContentOfAFileThatAnOptionNamesIsAnotherRun) {
  const std::filesystem::path mask = home_.path() / "mask.png";
  const std::string table = fmt::format(
      "method = \"sot\"\nexemplars = \"ring\"\nparams.shape = \"mask\"\nparams.mask = \"{}\"", mask.string());
  EXPECT_THAT(table_error(table), AllOf(HasSubstr("option mask: "), HasSubstr("mask.png: cannot be read")));
  std::ofstream(mask) << "one";
  const PlannedRun before = plan_table(table).runs.at(0);
  EXPECT_EQ(before.spec.file_sha256, (std::map<std::string, std::string>{{"mask", sha256("one")}}));
  EXPECT_EQ(plan_table(table).runs.at(0).id, before.id);
  EXPECT_EQ(run_id(run_spec_from_json(to_json(before.spec))), before.id);
  std::ofstream(mask) << "two";
  EXPECT_NE(plan_table(table).runs.at(0).id, before.id);
}

/// A mask may be a description, which is told in full by its text, or a file.
TEST_F(PlanTest, MasksThatAreFilesCountByTheirContent) {
  const std::string inpainting = "method = \"inpainting\"\nexemplars = \"ring\"\nperiodic = false\n";
  for (const char* shape : {"square", "rect:1,2,3,4"}) {
    const Plan named = plan_table(fmt::format("{}params.mask = \"{}\"", inpainting, shape));
    EXPECT_TRUE(named.runs.at(0).spec.file_sha256.empty()) << shape;
  }
  const std::filesystem::path mask = home_.path() / "mask.png";
  const std::string table = fmt::format("{}params.mask = \"{}\"", inpainting, mask.string());
  EXPECT_THAT(table_error(table), AllOf(HasSubstr("option mask: "), HasSubstr("mask.png: cannot be read")));
  std::ofstream(mask) << "one";
  EXPECT_EQ(plan_table(table).runs.at(0).spec.file_sha256,
            (std::map<std::string, std::string>{{"mask", sha256("one")}}));
}

TEST_F(PlanTest, AnotherRunDoesNotChangeAnId) {
  const Plan one = plan_table(rpn_ + "seeds = 2");
  const Plan many = plan_table("method = [\"adsn\", \"rpn\"]\nexemplars = [\"grass\", \"ring\"]\nseeds = [1, 2]");
  const auto same = [&](const PlannedRun& run) { return run.id == one.runs[0].id; };
  EXPECT_EQ(std::ranges::count_if(many.runs, same), 1);
}

/// Every config that is delivered can be planned with both profiles.
TEST(DeliveredConfigsTest, ArePlanned) {
  const DataVariable none("");
  const std::filesystem::path home = TEXTONBENCH_SOURCE_DIR;
  const ExemplarCatalog exemplars(home);
  int configs = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(home / "configs")) {
    if (entry.path().extension() != ".toml" || entry.path().filename() == "exemplars.toml") continue;
    if (entry.path().parent_path().filename() == "claims") continue;
    ++configs;
    for (const Profile profile : {Profile::quick, Profile::full}) {
      EXPECT_NO_THROW(EXPECT_GT(make_plan(read_config(entry.path(), profile), exemplars).runs.size(), 0U))
          << entry.path();
    }
  }
  EXPECT_GT(configs, 0);
}

}  // namespace textonbench::plan_test
