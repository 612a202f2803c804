// Sweeps that are killed, starved and disturbed, and what is left of their results.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "tests/cli/program.h"
#include "tests/temporary_folder.h"

namespace textonbench::faults_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::ordered_json;

class FaultsTest : public testing::Test {
 protected:
  std::filesystem::path file(const std::string& name) const { return folder_.path() / name; }

  /// sweep.toml: small samples of ADSN with as many seeds, each with a picture.
  void write_sweep(int seeds) const {
    std::ostringstream list;
    for (int seed = 1; seed <= seeds; ++seed) list << (seed > 1 ? ", " : "") << seed;
    std::ofstream(file("sweep.toml")) << "title = \"Sweep\"\nsource = \"test\"\n[[runs]]\nname = \"sweep\"\n"
                                      << "method = \"adsn\"\nexemplars = \"white_noise\"\nsize = [32, 32]\n"
                                      << "periodic = false\nmetrics = \"mean_error\"\npictures = \"sample\"\n"
                                      << "seeds = [" << list.str() << "]\n";
  }

  std::vector<std::string> lines_of(const std::string& records) const {
    std::vector<std::string> lines;
    std::ifstream in(file(records));
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
  }

  /// What a results folder says of each id, without times and machine: the last success, or else the last record. A
  /// line that is no record is a failure.
  std::map<std::string, Json> outcome_of(const std::string& records) const {
    std::map<std::string, Json> outcomes;
    for (const std::string& line : lines_of(records)) {
      Json record = Json::parse(line, nullptr, false);
      EXPECT_TRUE(record.is_object()) << line;
      if (!record.is_object()) continue;
      record.erase("time");
      record.erase("provenance");
      Json& kept = outcomes[record["id"].get<std::string>()];
      if (kept.is_null() || record["status"] == "ok") kept = record;
    }
    return outcomes;
  }

  std::size_t count_lines(const std::string& records) const {
    const std::string text = content_of(file(records));
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  }

  /// Waits until there are that many records, or the program has ended: false then.
  bool wait_for_records(std::size_t count, pid_t program) const {
    while (count_lines("results/records.jsonl") < count) {
      if (waitpid(program, nullptr, WNOHANG) != 0) return false;
      usleep(500);
    }
    return true;
  }

  TemporaryFolder folder_;
  Surroundings surroundings_{folder_.path()};
};

std::vector<pid_t> children_of(pid_t parent) {
  std::ifstream in("/proc/" + std::to_string(parent) + "/task/" + std::to_string(parent) + "/children");
  std::vector<pid_t> children;
  for (pid_t child = 0; in >> child;) children.push_back(child);
  return children;
}

TEST_F(FaultsTest, ASweepKilledTwentyTimesEndsAsAnUndisturbedOne) {
#ifdef __SANITIZE_ADDRESS__
  constexpr int runs = 50, rounds = 5;  // a run takes ten times as long
#else
  constexpr int runs = 200, rounds = 20;
#endif
  write_sweep(runs);
  std::mt19937 random(20140901);  // its raw output is the same everywhere
  std::size_t recorded = 0;
  for (int round = 0; round < rounds; ++round) {
    const pid_t program = start_program({"run", "sweep.toml", "--jobs", "2"}, surroundings_);
    // A child dies, then its parent, after some records each: at most 7 a round, so that the sweep cannot end before.
    ASSERT_TRUE(wait_for_records(recorded + random() % 4, program)) << content_of(file("stderr"));
    usleep(static_cast<useconds_t>(random() % 20000));
    const std::vector<pid_t> children = children_of(program);
    if (!children.empty()) kill(children[random() % children.size()], SIGKILL);
    ASSERT_TRUE(wait_for_records(count_lines("results/records.jsonl") + random() % 3, program));
    usleep(static_cast<useconds_t>(random() % 10000));
    kill(program, SIGKILL);
    waitpid(program, nullptr, 0);
    recorded = count_lines("results/records.jsonl");
  }
  EXPECT_LT(recorded, std::size_t{runs});
  const Outcome resumed = run_program({"run", "sweep.toml", "--jobs", "2", "--json"}, surroundings_);
  ASSERT_EQ(resumed.status, 0) << resumed.err;
  const Outcome undisturbed = run_program({"run", "sweep.toml", "--results", "undisturbed"}, surroundings_);
  ASSERT_EQ(undisturbed.status, 0) << undisturbed.err;

  const std::map<std::string, Json> outcome = outcome_of("results/records.jsonl");
  EXPECT_EQ(outcome.size(), std::size_t{runs});
  EXPECT_EQ(outcome, outcome_of("undisturbed/records.jsonl"));
  for (const auto& [id, record] : outcome) {
    const std::string picture = record["pictures"]["sample"]["file"];
    EXPECT_EQ(content_of(file("results") / picture), content_of(file("undisturbed") / picture)) << id;
  }
  for (const char* folder : {"results/pictures", "results/logs"}) {
    for (const auto& entry : std::filesystem::directory_iterator(file(folder))) {
      EXPECT_THAT(entry.path().filename().string(), Not(testing::StartsWith(".draft_")));
    }
  }
}

TEST_F(FaultsTest, TwoSweepsAtOnceShareAFolder) {
  write_sweep(40);
  const pid_t other = start_program({"run", "sweep.toml", "--jobs", "2"}, surroundings_);
  Surroundings apart{file("apart")};
  std::filesystem::create_directory(apart.folder);
  const Outcome outcome =
      run_program({"run", file("sweep.toml").string(), "--results", file("results").string()}, apart);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  int status = 0;
  waitpid(other, &status, 0);
  EXPECT_EQ(status, 0);
  const std::map<std::string, Json> records = outcome_of("results/records.jsonl");
  EXPECT_EQ(records.size(), 40U);
  for (const auto& [id, record] : records) {
    EXPECT_EQ(record["status"], "ok");
    EXPECT_TRUE(std::filesystem::exists(file("results") / record["pictures"]["sample"]["file"].get<std::string>()));
  }
}

TEST_F(FaultsTest, ACorruptedLineIsNamedAndTheRestKept) {
  write_sweep(5);
  ASSERT_EQ(run_program({"run", "sweep.toml"}, surroundings_).status, 0);
  std::vector<std::string> lines = lines_of("results/records.jsonl");
  ASSERT_EQ(lines.size(), 5U);
  lines[1].replace(40, 3, std::string("\0\xff\"", 3));
  {
    std::ofstream out(file("results/records.jsonl"), std::ios::binary);
    for (const std::string& line : lines) out << line << "\n";
  }
  const Outcome outcome = run_program({"run", "sweep.toml"}, surroundings_);
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.err, HasSubstr("results/records.jsonl:2: skipped"));
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("1 recorded"), HasSubstr("4 reused")));
  const std::vector<std::string> after = lines_of("results/records.jsonl");
  ASSERT_EQ(after.size(), 6U);
  EXPECT_TRUE(std::equal(lines.begin(), lines.end(), after.begin())) << "nothing is rewritten";
}

// A small file system of its own, in a namespace where mounting is allowed.
TEST_F(FaultsTest, AFullDiskStopsTheSweepAndFreeSpaceLetsItGoOn) {
  if (std::system("unshare -rm mount -t tmpfs none /mnt 2>/dev/null") != 0) {
    GTEST_SKIP() << "mounting is not allowed here; RunCommandTest.AFullDiskLosesNothingThatIsRecorded stands in";
  }
  write_sweep(30);
  std::filesystem::create_directory(file("results"));
  std::ofstream(file("script.sh")) << "mount -t tmpfs -o size=256k none results || exit 3\n"
                                      "head -c 200000 /dev/zero > results/filler\n"
                                      "\"$PROGRAM\" run sweep.toml > out1 2> err1; echo $? > status1\n"
                                      "cp results/records.jsonl full.jsonl\n"
                                      "rm results/filler && mount -o remount,size=4m results || exit 4\n"
                                      "\"$PROGRAM\" run sweep.toml > out2 2> err2; echo $? > status2\n"
                                      "cp results/records.jsonl resumed.jsonl\n";
  const std::string command = "cd " + folder_.path().string() + " && PROGRAM=" + TEXTONBENCH_PROGRAM +
                              " TEXTONBENCH_HOME=" + TEXTONBENCH_SOURCE_DIR + " unshare -rm sh script.sh";
  ASSERT_EQ(std::system(command.c_str()), 0);
  // 1 as long as the records of runs that lack the space for their picture still fit, 2 from then on.
  EXPECT_THAT(content_of(file("status1")), testing::AnyOf("1\n", "2\n"));
  EXPECT_THAT(content_of(file("err1")), HasSubstr("No space left"));
  const std::map<std::string, Json> full = outcome_of("full.jsonl");
  EXPECT_LT(full.size(), 30U);
  EXPECT_EQ(content_of(file("status2")), "0\n") << content_of(file("err2"));
  const std::map<std::string, Json> resumed = outcome_of("resumed.jsonl");
  EXPECT_EQ(resumed.size(), 30U);
  for (const auto& [id, record] : resumed) EXPECT_EQ(record["status"], "ok");
}

TEST_F(FaultsTest, AClockThatJumpsDisturbsNeitherTimeoutsNorDurations) {
  write_sweep(8);
  Surroundings jumping = surroundings_;
  // A sanitizer's runtime would rather be loaded first; this library has nothing for it to check.
  jumping.environment = {{"LD_PRELOAD", TEXTONBENCH_JUMPING_CLOCK}, {"ASAN_OPTIONS", "verify_asan_link_order=0"}};
  const auto start = std::chrono::steady_clock::now();
  const Outcome outcome = run_program({"run", "sweep.toml", "--json"}, jumping);
  const std::chrono::duration<double> most = std::chrono::steady_clock::now() - start;
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const Json told = Json::parse(outcome.out);
  EXPECT_EQ(told["recorded"], 8);
  EXPECT_GT(told["seconds"].get<double>(), 0);
  EXPECT_LT(told["seconds"].get<double>(), most.count());
  for (const std::string& line : lines_of("results/records.jsonl")) {
    const Json time = Json::parse(line)["time"];
    EXPECT_GT(time["wall_seconds"].get<double>(), 0);
    EXPECT_LT(time["wall_seconds"].get<double>(), most.count());
  }
  EXPECT_THAT(run_program({"run", "sweep.toml"}, surroundings_).out, HasSubstr("8 reused"));
}

}  // namespace textonbench::faults_test
