// `textonbench claims`: the ledger as a user and a script meet it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/cli/program.h"
#include "tests/temporary_folder.h"

namespace textonbench::claims_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::ordered_json;

class ClaimsCommandTest : public testing::Test {
 protected:
  Outcome run(const std::vector<std::string>& arguments) const { return run_program(arguments, surroundings_); }
  Json run_json(std::vector<std::string> arguments, int status = 0) const {
    arguments.emplace_back("--json");
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, status) << outcome.err;
    return Json::parse(outcome.out);
  }
  void record_verdict(const std::string& id, const std::string& verdict) const {
    std::filesystem::create_directories(folder_.path() / "results" / "baseline");
    std::ofstream(folder_.path() / "results" / "baseline" / "claims.json")
        << "{\"claims\": {\"" << id << "\": \"" << verdict << "\"}}";
  }

  TemporaryFolder folder_;
  Surroundings surroundings_{folder_.path()};
};

TEST_F(ClaimsCommandTest, WithoutRecordsEveryClaimSaysWhatItWaitsFor) {
  const Json told = run_json({"claims"});
  EXPECT_GE(told["claims"].size(), 163U);
  EXPECT_EQ(told["counts"]["not run"], told["claims"].size());
  for (const Json& claim : told["claims"]) {
    EXPECT_FALSE(claim["reason"].get<std::string>().empty()) << claim["id"];
    EXPECT_TRUE(claim["measured"].is_null() && claim["interval"].is_null() && claim["record"].is_null());
  }
  EXPECT_EQ(run_json({"list", "claims"})["claims"].size(), told["claims"].size());
}

TEST_F(ClaimsCommandTest, FiltersAndTables) {
  const Json one = run_json({"claims", "--id", "S02", "--paper", "Lectures 2022", "--verdict", "not run"});
  ASSERT_EQ(one["claims"].size(), 1U);
  EXPECT_THAT(one["claims"][0]["reason"].get<std::string>(), HasSubstr("textonbench run lectures2022/claims"));
  const Outcome table = run({"claims", "--id", "T41"});
  EXPECT_THAT(table.out, AllOf(HasSubstr("method not yet built: quilting"), HasSubstr("1 claims: 0 reproduced")));
  const Json deviating = run_json({"claims", "--verdict", "deviates"});
  EXPECT_TRUE(deviating["claims"].empty());
}

TEST_F(ClaimsCommandTest, OnlyAWorseVerdictEndsWithStatus1) {
  const std::string sweep = "lectures2022/claims_borders";
  // A record of every run that S09 asks for, written by hand: without the cross's removal nothing changes.
  const Json planned = run_json({"run", sweep, "--dry-run"});
  std::filesystem::create_directories(folder_.path() / "results");
  std::ofstream records(folder_.path() / "results" / "records.jsonl");
  for (const Json& run : planned["runs"]) {
    const bool raw = run["command"].get<std::string>().find("component=raw") != std::string::npos;
    records << Json{{"schema", 1},
                    {"id", run["id"]},
                    {"status", "ok"},
                    {"metrics",
                     {{"axis_energy_ratio", {{"value", raw ? 1.0 : 2.0}}}, {"axis_power_error", {{"value", 1.0}}}}}}
            << '\n';
  }
  records.close();
  const std::vector<std::string> command{"claims", "--id", "S09"};
  Json told = run_json(command);
  if (told["claims"][0]["verdict"] == "not run") GTEST_SKIP() << "none of the exemplars is installed";
  EXPECT_EQ(told["claims"][0]["measured"], 0.5);
  EXPECT_FALSE(told["claims"][0]["record"].is_null());
  record_verdict("S09", "reproduced");
  told = run_json(command, 1);
  EXPECT_EQ(told["worse"][0]["now"], told["claims"][0]["verdict"]);
  record_verdict("S09", "deviates");
  run_json(command);
  record_verdict("S02", "reproduced");
  const Outcome outcome = run({"claims", "--id", "S02"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.err, HasSubstr("warning: S02 is no longer run"));
}

TEST_F(ClaimsCommandTest, ClaimsAreNoExperiments) {
  EXPECT_THAT(run({"list", "configs"}).out,
              AllOf(HasSubstr("lectures2022/claims"), Not(HasSubstr("claims/eusipco2014"))));
}

}  // namespace textonbench::claims_test
