// `textonbench run`: sweeps, and what may befall them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/cli/program.h"
#include "tests/temporary_folder.h"

namespace textonbench::run_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;
using Json = nlohmann::ordered_json;

class RunCommandTest : public testing::Test {
 protected:
  Outcome run(const std::vector<std::string>& arguments) const { return run_program(arguments, surroundings_); }
  Json run_json(std::vector<std::string> arguments, int status = 0) const {
    arguments.emplace_back("--json");
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, status) << outcome.err;
    return Json::parse(outcome.out);
  }
  std::filesystem::path file(const std::string& name) const { return folder_.path() / name; }
  /// sweep.toml: RPN of white noise with as many seeds.
  void write_sweep(int seeds, const std::string& more = "") const {
    std::ostringstream list;
    for (int seed = 1; seed <= seeds; ++seed) list << (seed > 1 ? ", " : "") << seed;
    std::ofstream(file("sweep.toml")) << "title = \"Sweep\"\nsource = \"test\"\n[[runs]]\nname = \"sweep\"\n"
                                      << "method = \"rpn\"\nexemplars = [\"white_noise\"]\nmetrics = [\"mean_error\"]\n"
                                      << "seeds = [" << list.str() << "]\n"
                                      << more;
  }
  /// How often each id stands in records.jsonl; every line must be a record.
  std::map<std::string, int> recorded_ids() const {
    std::map<std::string, int> counts;
    std::ifstream in(file("results/records.jsonl"));
    for (std::string line; std::getline(in, line);) ++counts[Json::parse(line)["id"].get<std::string>()];
    return counts;
  }
  std::size_t record_count() const {
    std::size_t count = 0;
    for (const auto& [id, times] : recorded_ids()) count += static_cast<std::size_t>(times);
    return count;
  }

  TemporaryFolder folder_;
  Surroundings surroundings_{folder_.path()};
};

TEST_F(RunCommandTest, RecordsThePlanAndReusesIt) {
  write_sweep(4);
  Json told = run_json({"run", "sweep.toml", "--jobs", "2"});
  EXPECT_EQ(told["planned"], 4);
  EXPECT_EQ(told["recorded"], 4);
  EXPECT_GT(told["seconds"].get<double>(), 0);
  told = run_json({"run", "sweep.toml"});
  EXPECT_EQ(told["recorded"], 0);
  EXPECT_EQ(told["reused"], 4);
  EXPECT_EQ(recorded_ids().size(), 4U);
  EXPECT_EQ(record_count(), 4U);
  told = run_json({"run", "sweep.toml", "--fresh", "--results", "elsewhere"});
  EXPECT_EQ(told["recorded"], 4);
  EXPECT_TRUE(std::filesystem::exists(file("elsewhere/records.jsonl")));
}

TEST_F(RunCommandTest, ADryRunExecutesNothing) {
  write_sweep(3);
  const Json told = run_json({"run", "sweep.toml", "--dry-run"});
  EXPECT_EQ(told["planned"], 3);
  ASSERT_EQ(told["runs"].size(), 3U);
  EXPECT_THAT(told["runs"][0]["command"].get<std::string>(), StartsWith("textonbench measure rpn white_noise"));
  const Outcome table = run({"run", "sweep.toml", "--dry-run"});
  EXPECT_THAT(table.out, AllOf(HasSubstr("rpn"), HasSubstr("white_noise"), HasSubstr("3 runs planned")));
  EXPECT_FALSE(std::filesystem::exists(file("results")));
}

TEST_F(RunCommandTest, ADryRunEstimatesFromEarlierRecords) {
  write_sweep(2);
  EXPECT_THAT(run({"run", "sweep.toml", "--dry-run"}).out,
              HasSubstr("0 reused; the time of 2 is unknown: no record of rpn yet"));
  run_json({"run", "sweep.toml"});
  write_sweep(4, "[[runs]]\nname = \"other\"\nmethod = \"adsn\"\nexemplars = \"ring\"\n");
  Json told = run_json({"run", "sweep.toml", "--dry-run"});
  EXPECT_EQ(told["reused"], 2);
  EXPECT_EQ(told["unknown"], 1);
  const double seconds = told["estimated_seconds"].get<double>();
  EXPECT_GT(seconds, 0);
  told = run_json({"run", "sweep.toml", "--dry-run", "--fresh", "--jobs", "2"});
  EXPECT_EQ(told["reused"], 0);
  EXPECT_NEAR(told["estimated_seconds"].get<double>(), seconds, 1e-9) << "twice the runs, two at once";
  EXPECT_EQ(record_count(), 2U);
}

TEST_F(RunCommandTest, ExplainSaysWhyARunWouldBeMade) {
  write_sweep(2);
  run_json({"run", "sweep.toml"});
  write_sweep(3);
  const Outcome outcome = run({"run", "sweep.toml", "--explain"});
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("reuse textonbench measure rpn white_noise"),
                                 HasSubstr("run   textonbench measure rpn white_noise"),
                                 HasSubstr("never run: differs from the nearest recorded run in seed (2 -> 3)"),
                                 HasSubstr("3 runs planned, 2 to reuse, 1 to run")));
  const Json told = run_json({"run", "sweep.toml", "--explain", "--fresh"});
  EXPECT_EQ(told["reused"], 0);
  EXPECT_EQ(told["runs"][0]["action"], "run");
  EXPECT_EQ(told["runs"][0]["reason"], "asked for by --fresh");
  EXPECT_EQ(record_count(), 2U);
}

TEST_F(RunCommandTest, MergedRecordsAreReused) {
  write_sweep(2);
  run_json({"run", "sweep.toml", "--results", "elsewhere"});
  const Json merged = run_json({"merge", "elsewhere", "elsewhere/records.jsonl"})["merged"];
  EXPECT_EQ(merged[0]["added"], 2);
  EXPECT_EQ(merged[1]["added"], 0);
  EXPECT_EQ(merged[1]["present"], 2);
  EXPECT_EQ(run_json({"run", "sweep.toml"})["reused"], 2);
  const Outcome outcome = run({"merge", "nowhere"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("nowhere: expected a records file"));
}

TEST_F(RunCommandTest, ARecordsCommandRepeatsItsNumbers) {
  std::ofstream(file("window.toml"))
      << "title = \"Windows\"\nsource = \"test\"\n[[runs]]\nname = \"windows\"\nmethod = \"adsn\"\n"
         "exemplars = [\"ring\"]\nmetrics = [\"mean_error\"]\nsamples = 2\nperiodic = [true, false]\n"
         "size = [[256, 256]]\n[[runs]]\nname = \"own\"\nmethod = \"adsn\"\nexemplars = [\"ring\"]\nsamples = 2\n"
         "metrics = [\"mean_error\"]\nperiodic = [true, false]\n";
  run_json({"run", "window.toml"});
  std::ifstream in(file("results/records.jsonl"));
  int lines = 0;
  for (std::string line; std::getline(in, line); ++lines) {
    const Json record = Json::parse(line);
    std::istringstream command(record["command"].get<std::string>());
    std::vector<std::string> words;
    for (std::string word; command >> word;) words.push_back(word);
    ASSERT_EQ(words.front(), "textonbench");
    words.erase(words.begin());
    words.insert(words.end(), {"--metrics", "mean_error"});
    EXPECT_EQ(run_json(words)["metrics"], record["metrics"]) << record["command"];
  }
  EXPECT_EQ(lines, 4);
}

TEST_F(RunCommandTest, AFilterChoosesRuns) {
  write_sweep(12, "[[runs]]\nname = \"other\"\nmethod = [\"adsn\"]\nexemplars = [\"ring\"]\nseeds = [1]\n");
  const auto planned = [&](const std::string& filter) {
    return run_json({"run", "sweep.toml", "--dry-run", "--filter", filter})["planned"].get<int>();
  };
  EXPECT_EQ(planned("method=rpn"), 12);
  EXPECT_EQ(planned("seed=1*"), 5);
  EXPECT_EQ(planned("seed=1*,exemplar=white*"), 4);
  EXPECT_EQ(planned("label=other"), 1);
  EXPECT_EQ(planned("phase=added"), 12);
  for (const std::string bad : {"method", "colour=red", "method=gabor"}) {
    const Outcome outcome = run({"run", "sweep.toml", "--dry-run", "--filter", bad});
    EXPECT_EQ(outcome.status, 2) << bad;
    EXPECT_THAT(outcome.err, AllOf(StartsWith("textonbench: error: --filter"), HasSubstr(bad.substr(0, 5)))) << bad;
  }
}

TEST_F(RunCommandTest, ABadConfigIsToldWithItsPlace) {
  std::ofstream(file("bad.toml")) << "title = \"Bad\"\nsource = \"test\"\n[[runs]]\nname = \"a\"\nmethd = \"rpn\"\n";
  const Outcome outcome = run({"run", "bad.toml"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, AllOf(StartsWith("textonbench: error: "), HasSubstr("bad.toml:5:"), HasSubstr("method")));
}

TEST_F(RunCommandTest, AHugeSweepAsksForTheFlag) {
  std::string seeds;
  for (int i = 0; i < 1000; ++i) seeds += (i > 0 ? "," : "") + std::to_string(i);
  std::string sizes;
  for (int i = 0; i < 1000; ++i) sizes += (i > 0 ? ",[" : "[") + std::to_string(i + 8) + ",8]";
  std::ofstream(file("huge.toml")) << "title = \"Huge\"\nsource = \"test\"\n[[runs]]\nname = \"a\"\nmethod = \"adsn\"\n"
                                   << "exemplars = [\"ring\"]\nseeds = [" << seeds << "]\nsize = [" << sizes << "]\n";
  const Outcome outcome = run({"run", "huge.toml"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("1000000"), HasSubstr("--yes-large")));
  EXPECT_FALSE(std::filesystem::exists(file("results")));
}

TEST_F(RunCommandTest, AFailedRunIsStatus1AndKeepsTheOthers) {
  write_sweep(2,
              "[[runs]]\nname = \"late\"\nmethod = \"rpn\"\nexemplars = [\"white_noise\"]\nsamples = 1000000\n"
              "timeout_seconds = 0.3\n");
  const Json told = run_json({"run", "sweep.toml"}, 1);
  EXPECT_EQ(told["recorded"], 2);
  EXPECT_EQ(told["failed"], 1);
  const Outcome again = run({"run", "sweep.toml"});
  EXPECT_EQ(again.status, 1);
  EXPECT_THAT(again.out, HasSubstr("2 reused"));
  EXPECT_THAT(again.err, HasSubstr("no result within 0.3 s"));
}

TEST_F(RunCommandTest, ARunKilledHalfwayGoesOnFromThere) {
  constexpr int seeds = 40;
  write_sweep(seeds);
  const pid_t pid = start_program({"run", "sweep.toml", "--jobs", "2"}, surroundings_);
  while (content_of(file("results/records.jsonl")).size() < 5000) {
    ASSERT_EQ(waitpid(pid, nullptr, WNOHANG), 0) << content_of(file("stderr"));
    usleep(1000);
  }
  kill(pid, SIGKILL);
  waitpid(pid, nullptr, 0);
  const std::size_t halfway = record_count();
  ASSERT_GT(halfway, 0U);
  ASSERT_LT(halfway, std::size_t{seeds});
  const Json told = run_json({"run", "sweep.toml", "--jobs", "2"});
  EXPECT_EQ(told["reused"], halfway);
  EXPECT_EQ(told["recorded"], seeds - halfway);
  EXPECT_EQ(recorded_ids().size(), std::size_t{seeds});
  EXPECT_EQ(record_count(), std::size_t{seeds}) << "each record stands there once";
}

TEST_F(RunCommandTest, AnInterruptKeepsWhatIsRecorded) {
  write_sweep(60);
  const pid_t pid = start_program({"run", "sweep.toml"}, surroundings_);
  while (content_of(file("results/records.jsonl")).empty()) {
    ASSERT_EQ(waitpid(pid, nullptr, WNOHANG), 0) << content_of(file("stderr"));
    usleep(1000);
  }
  kill(pid, SIGTERM);
  int status = 0;
  waitpid(pid, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 1);
  EXPECT_THAT(content_of(file("stderr")), HasSubstr("the same command goes on from there"));
  EXPECT_GT(record_count(), 0U);
}

TEST_F(RunCommandTest, TwoProcessesMayWriteAtOnce) {
  write_sweep(20);
  const pid_t other = start_program({"run", "sweep.toml", "--fresh"}, surroundings_);
  Surroundings apart = surroundings_;
  apart.folder = file("apart");
  std::filesystem::create_directory(apart.folder);
  const Outcome outcome =
      run_program({"run", file("sweep.toml").string(), "--fresh", "--results", file("results").string()}, apart);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  int status = 0;
  waitpid(other, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(recorded_ids().size(), 20U);
  EXPECT_EQ(record_count(), 40U);
}

TEST_F(RunCommandTest, ADamagedLineIsToldAndTheRestIsReused) {
  write_sweep(3);
  run_json({"run", "sweep.toml"});
  const std::filesystem::path records = file("results/records.jsonl");
  std::filesystem::resize_file(records, std::filesystem::file_size(records) - 100);
  const Outcome outcome = run({"run", "sweep.toml"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.err, HasSubstr("records.jsonl:3: skipped"));
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("1 recorded"), HasSubstr("2 reused")));
  EXPECT_THAT(run({"run", "sweep.toml"}).out, HasSubstr("3 reused"));
}

TEST_F(RunCommandTest, AnUnwritableResultsFolderIsNamed) {
  write_sweep(1);
  const Outcome outcome = run({"run", "sweep.toml", "--results", "sweep.toml/results"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, AllOf(StartsWith("textonbench: error: "), HasSubstr("sweep.toml/results")));
}

// A file size limit stands for the full disk.
TEST_F(RunCommandTest, AFullDiskLosesNothingThatIsRecorded) {
  write_sweep(2);
  run_json({"run", "sweep.toml"});
  const std::string before = content_of(file("results/records.jsonl"));
  write_sweep(4);
  Surroundings full = surroundings_;
  full.largest_file = before.size() + 100;
  const Outcome outcome = run_program({"run", "sweep.toml"}, full);
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("textonbench: error: "), HasSubstr("records.jsonl")));
  EXPECT_EQ(content_of(file("results/records.jsonl")), before);
  EXPECT_THAT(run({"run", "sweep.toml"}).out, AllOf(HasSubstr("2 recorded"), HasSubstr("2 reused")));
}

}  // namespace textonbench::run_test
