// The tables of frame times that `textonbench run` ends with.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/cli/program.h"
#include "tests/temporary_folder.h"

namespace textonbench::run_frames_test {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::ordered_json;

class RunFramesTest : public testing::Test {
 protected:
  Outcome run(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"run", "frames.toml"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments, surroundings_);
  }
  std::filesystem::path records() const { return folder_.path() / "results" / "records.jsonl"; }
  void write_config(const std::string& rows) const {
    std::ofstream(folder_.path() / "frames.toml")
        << "title = \"Frames\"\nsource = \"test\"\n[[runs]]\nname = \"frames\"\nmethod = \"rpn\"\n"
        << "exemplars = [\"white_noise\"]\nmetrics = [\"mean_error\"]\nseeds = [1, 2]\n"
        << "params.phase = [\"added\", \"replaced\"]\n"
        << "[[figures]]\nname = \"frames\"\nkind = \"frame_table\"\ntitle = \"Times\"\n"
        << rows;
  }
  /// Gives the records the times that a graphics processor would: 2 ms for phase = added, 3 ms for the other.
  void add_times() const {
    std::ostringstream timed;
    std::ifstream in(records());
    for (std::string line; std::getline(in, line);) {
      Json record = Json::parse(line);
      const double ms = record["spec"]["params"]["phase"] == "added" ? 2 : 3;
      record["timing"] = {{"ms", {{"median", ms}, {"p05", ms}, {"p95", ms}}},
                          {"ns_per_pixel", ms},
                          {"fetches_per_second", 1e9},
                          {"fetch_ceiling_fraction", 0.5}};
      record["provenance"]["gpu"] = {{"renderer", "Abacus 3000"}, {"software", false}};
      timed << record.dump() << '\n';
    }
    in.close();
    std::ofstream(records()) << timed.str();
  }

  TemporaryFolder folder_;
  Surroundings surroundings_{folder_.path()};
};

constexpr const char* two_rows =
    "rows = [{run = \"frames\", phase = \"added\", label = \"one\"},\n"
    "        {run = \"frames\", phase = \"replaced\", label = \"other\"}]\n"
    "ratios = [{label = \"other to one\", of = \"other\", over = \"one\"}]\n";

TEST_F(RunFramesTest, TheTableStandsBelowTheSummary) {
  write_config(two_rows);
  EXPECT_THAT(run().out, EndsWith("\n\nTimes\n  its record holds no times of frames\n"));
  add_times();
  const Outcome again = run();
  EXPECT_EQ(again.status, 0);
  EXPECT_THAT(again.out, AllOf(HasSubstr("4 reused"), HasSubstr("\n\nTimes\nAbacus 3000\n"),
                               HasSubstr("one       2  2.000"), EndsWith("\nother to one  1.50      –\n")));
  EXPECT_EQ(Json::parse(run({"--json"}).out)["reused"], 4);
  EXPECT_THAT(run({"--dry-run"}).out, Not(HasSubstr("Times")));
}

TEST_F(RunFramesTest, ATableThatCannotBeIsToldBeforeAnyRun) {
  for (const std::string rows :
       {"", "rows = [{run = \"frames\"}]\n", "rows = [{run = \"frames\", label = \"both\"}]\n"}) {
    write_config(rows);
    const Outcome outcome = run();
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.err, HasSubstr("textonbench: error: frames.toml:1"));
    EXPECT_FALSE(std::filesystem::exists(records()));
  }
}

}  // namespace textonbench::run_frames_test
