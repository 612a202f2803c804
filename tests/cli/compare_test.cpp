// compare, baseline and export, as a user starts them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/cli/program.h"
#include "tests/experiments/synthetic_results.h"
#include "tests/temporary_folder.h"

namespace textonbench::cli_compare_test {

using testing::AllOf;
using testing::HasSubstr;

class CompareProgram : public testing::Test {
 protected:
  Outcome start(const std::vector<std::string>& arguments) const { return run_program(arguments, {folder_.path()}); }
  void write(const std::string& folder, double rme) const {
    std::filesystem::create_directories(folder_.path() / folder);
    std::ofstream out(folder_.path() / folder / "records.jsonl");
    const ResultSet set = make_synthetic_set([&](SyntheticRun& run) {
      run.metrics = {{"rme", rme + 1e-4 * static_cast<double>(run.exemplar.back() % 5)}};
    });
    for (const auto& [computation, record] : set.runs) out << record.dump() << "\n";
  }

  TemporaryFolder folder_;
};

TEST_F(CompareProgram, TellsWorseByItsStatus) {
  write("before", 0.5);
  write("after", 0.52);
  const Outcome worse = start({"compare", "before", "after/records.jsonl"});
  EXPECT_EQ(worse.status, 1) << worse.err;
  EXPECT_THAT(worse.out, AllOf(HasSubstr("rme"), HasSubstr("worse"), HasSubstr("+3.9"), HasSubstr("; 1 regression\n")));
  EXPECT_EQ(start({"compare", "after", "before"}).status, 0);

  const Outcome json = start({"compare", "before", "after", "--json"});
  EXPECT_EQ(json.status, 1);
  const auto document = nlohmann::json::parse(json.out);
  EXPECT_EQ(document["regressions"], 1);
  EXPECT_EQ(document["metrics"][0]["name"], "rme");
  EXPECT_EQ(document["metrics"][0]["verdict"], "worse");
  EXPECT_NEAR(document["metrics"][0]["estimate"].get<double>(), 0.0392, 1e-3);
  EXPECT_EQ(document["metrics"][0]["interval"].size(), 2U);
}

TEST_F(CompareProgram, RefusesSetsThatCannotBeCompared) {
  write("before", 0.5);
  EXPECT_EQ(start({"compare", "before"}).status, 2);
  EXPECT_EQ(start({"compare", "before", "nowhere"}).status, 2);
  const Outcome none = start({"compare", "before"});
  EXPECT_THAT(none.err, HasSubstr("Expected OLD NEW"));
  std::ofstream(folder_.path() / "other.jsonl") << make_synthetic_record({.exemplar = "elsewhere"}).dump() << "\n";
  const Outcome unrelated = start({"compare", "before", "other.jsonl"});
  EXPECT_EQ(unrelated.status, 2);
  EXPECT_THAT(unrelated.err, AllOf(HasSubstr("share no run"), HasSubstr("elsewhere")));
}

TEST_F(CompareProgram, BaselineIsUpdatedAndComparedWith) {
  write("results", 0.5);
  const Outcome none = start({"compare"});
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.err, HasSubstr("results/baseline"));
  EXPECT_EQ(start({"baseline", "update", "--reason", " "}).status, 2);
  EXPECT_EQ(start({"baseline", "update"}).status, 2);
  const Outcome update = start({"baseline", "update", "--reason", "first numbers"});
  EXPECT_EQ(update.status, 0) << update.err;
  EXPECT_EQ(start({"compare"}).status, 0);
  write("results", 0.55);
  EXPECT_EQ(start({"compare"}).status, 1);
  write("candidate", 0.5);
  EXPECT_EQ(start({"compare", "--baseline", "candidate"}).status, 0);
  EXPECT_EQ(start({"compare", "--baseline", "candidate", "results"}).status, 2);

  std::ofstream(folder_.path() / "results/baseline/records.jsonl") << "{\"schema\": 2, \"id\": \"a\"}\n";
  const Outcome migrate = start({"compare"});
  EXPECT_EQ(migrate.status, 2);
  EXPECT_THAT(migrate.err, AllOf(HasSubstr("schema 2"), HasSubstr("baseline update --reason")));
}

TEST_F(CompareProgram, DamagedClaimsLeaveTheBaselineAsItWas) {
  write("results", 0.5);
  ASSERT_EQ(start({"baseline", "update", "--reason", "first numbers"}).status, 0);
  const std::filesystem::path baseline = folder_.path() / "results/baseline";
  const std::string before = content_of(baseline / "records.jsonl");
  write("results", 0.6);
  const std::filesystem::path home = folder_.path() / "home";
  std::filesystem::create_directories(home);
  std::filesystem::copy(TEXTONBENCH_SOURCE_DIR "/configs", home / "configs", std::filesystem::copy_options::recursive);
  std::ofstream(home / "configs/claims/bad.toml") << "paper = \"P\"\n[[claims]]\nid = 7\n";
  const Outcome refused = run_program({"baseline", "update", "--reason", "more"},
                                      {.folder = folder_.path(), .environment = {{"TEXTONBENCH_HOME", home.string()}}});
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("bad.toml:3:"));
  EXPECT_EQ(content_of(baseline / "records.jsonl"), before);
}

TEST_F(CompareProgram, ExportsBothFormats) {
  write("results", 0.5);
  EXPECT_EQ(start({"export"}).status, 2);
  EXPECT_EQ(start({"--results", "empty", "export", "--csv", "tables"}).status, 2);
  const Outcome outcome = start({"export", "--csv", "tables", "--sqlite", "results.sqlite"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("tables/runs.csv"), HasSubstr("results.sqlite")));
  EXPECT_THAT(content_of(folder_.path() / "tables/metrics.csv"), HasSubstr("adsn_exemplar_0_1,rme,0.5"));
  EXPECT_TRUE(content_of(folder_.path() / "results.sqlite").starts_with("SQLite format 3"));
}

}  // namespace textonbench::cli_compare_test
