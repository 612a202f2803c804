#include "experiments/runner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <set>
#include <thread>

#include "experiments/child_process.h"
#include "tests/temporary_folder.h"

namespace textonbench::runner_test {

using testing::AllOf;
using testing::HasSubstr;

// --- children ------------------------------------------------------------------------------------------------------

class ChildProcessTest : public testing::Test {
 protected:
  /// Runs `work` to its end.
  std::unique_ptr<ChildProcess> finish(const std::function<std::string()>& work, double timeout_seconds = 60) const {
    auto child = std::make_unique<ChildProcess>(work, log(), timeout_seconds);
    while (!child->receive()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return child;
  }
  std::filesystem::path log() const { return folder_.path() / "log"; }

  TemporaryFolder folder_;
};

TEST_F(ChildProcessTest, ReturnsWhatItsWorkReturns) {
  // Longer than a pipe holds.
  std::string text(1000000, 'x');
  const auto child = finish([&] { return text; });
  EXPECT_EQ(child->failure(), "");
  EXPECT_EQ(child->output(), text);
  EXPECT_FALSE(std::filesystem::exists(log())) << "an empty log is not kept";
}

TEST_F(ChildProcessTest, ACrashIsToldWithTheSignalAndTheLastLines) {
  const auto child = finish([]() -> std::string {
    for (int i = 1; i <= 9; ++i) fprintf(stderr, "line %d\n", i);
    std::abort();
  });
  EXPECT_EQ(child->failure(), "killed by SIGABRT; its last words: line 7\nline 8\nline 9");
  EXPECT_TRUE(std::filesystem::exists(log()));
}

TEST_F(ChildProcessTest, AnEndlessLoopIsCutAtItsTimeout) {
  const auto start = std::chrono::steady_clock::now();
  const auto child = finish(
      []() -> std::string {
        while (true) pause();
      },
      0.05);
  EXPECT_THAT(child->failure(), HasSubstr("no result within 0.05 s"));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
}

TEST_F(ChildProcessTest, AnEarlyExitIsAFailureByItsStatus) {
  EXPECT_EQ(finish([]() -> std::string { _exit(3); })->failure(), "ended with status 3");
}

TEST_F(ChildProcessTest, DiesWithItsObject) {
  pid_t pid = 0;
  {
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    const ChildProcess child(
        [&]() -> std::string {
          const pid_t own = getpid();
          (void)!write(ends[1], &own, sizeof own);
          while (true) pause();
        },
        log(), 60);
    ASSERT_EQ(read(ends[0], &pid, sizeof pid), static_cast<ssize_t>(sizeof pid));
    EXPECT_EQ(kill(pid, 0), 0);
    close(ends[0]);
    close(ends[1]);
  }
  EXPECT_EQ(kill(pid, 0), -1);
}

// --- plans ---------------------------------------------------------------------------------------------------------

class RunnerTest : public testing::Test {
 protected:
  /// A run of RPN on white noise that takes some milliseconds.
  static PlannedRun make_run(std::uint64_t seed) {
    PlannedRun run;
    run.spec.method = "rpn";
    run.spec.params = Params(find_method("rpn").params, {}).values();
    run.spec.exemplar = "white_noise";
    run.spec.seed = seed;
    run.spec.metrics = {"mean_error"};
    return finish(run);
  }
  static PlannedRun finish(PlannedRun run) {
    run.id = run_id(run.spec);
    run.label = "test";
    return run;
  }
  static Plan make_small_plan(std::uint64_t count) {
    Plan plan;
    for (std::uint64_t seed = 1; seed <= count; ++seed) plan.runs.push_back(make_run(seed));
    return plan;
  }
  /// A run that would take hours.
  static Plan make_endless_plan() {
    PlannedRun run = make_run(1);
    run.spec.samples = 1 << 30;
    Plan plan;
    plan.runs = {finish(run)};
    return plan;
  }
  RunSummary run(const Plan& plan, RunOptions options = {}) {
    options.show_progress = false;
    return run_plan(plan, exemplars_, results_, options, &interrupted_);
  }
  std::vector<Record> records() const { return results_.read().records; }

  TemporaryFolder folder_;
  ResultsFolder results_{folder_.path()};
  ExemplarCatalog exemplars_{TEXTONBENCH_SOURCE_DIR};
  bool interrupted_ = true;
};

/// Kills the runner's child as soon as there is one; a process of its own, because the runner's must not have threads.
class Assassin {
 public:
  Assassin() {
    const pid_t parent = getpid();
    pid_ = fork();
    if (pid_ != 0) return;
    const std::string children = "/proc/" + std::to_string(parent) + "/task/" + std::to_string(parent) + "/children";
    while (true) {
      std::ifstream in(children);
      for (pid_t child = 0; in >> child;) {
        if (child == getpid()) continue;
        kill(child, SIGKILL);
        _exit(0);
      }
      usleep(1000);
    }
  }
  Assassin(const Assassin&) = delete;
  Assassin& operator=(const Assassin&) = delete;
  ~Assassin() { waitpid(pid_, nullptr, 0); }

 private:
  pid_t pid_ = -1;
};

TEST_F(RunnerTest, EveryPlannedRunBecomesARecord) {
  const Plan plan = make_small_plan(5);
  const RunSummary summary = run(plan, {.jobs = 2});
  EXPECT_EQ(summary.planned, 5U);
  EXPECT_EQ(summary.recorded, 5U);
  EXPECT_EQ(summary.failed + summary.reused + summary.refused, 0U);
  EXPECT_FALSE(interrupted_);
  std::set<std::string> planned, recorded;
  for (const PlannedRun& r : plan.runs) planned.insert(r.id);
  for (const Record& record : records()) recorded.insert(record["id"].get<std::string>());
  EXPECT_EQ(recorded, planned);
}

TEST_F(RunnerTest, WhatIsRecordedIsReusedUnlessFresh) {
  run(make_small_plan(2));
  const RunSummary more = run(make_small_plan(3));
  EXPECT_EQ(more.reused, 2U);
  EXPECT_EQ(more.recorded, 1U);
  const RunSummary fresh = run(make_small_plan(3), {.fresh = true});
  EXPECT_EQ(fresh.reused, 0U);
  EXPECT_EQ(fresh.recorded, 3U);
  EXPECT_EQ(records().size(), 6U);
}

TEST_F(RunnerTest, NumbersDoNotDependOnThreadsOrJobs) {
  PlannedRun planned = make_run(1);
  planned.spec.samples = 2;
  planned.spec.metrics = {"mean_error", "patch_distance", "rme"};
  planned.spec.pictures = {"sample"};
  Plan plan = make_small_plan(2);
  plan.runs.push_back(finish(planned));
  run(plan, {.jobs = 1, .threads = 1});
  run(plan, {.jobs = 3, .threads = 2, .fresh = true});
  std::vector<std::string> ids;
  for (const PlannedRun& r : plan.runs) ids.push_back(r.id);
  const std::vector<Record> all = records();
  const auto first = latest_by_id({all.begin(), all.begin() + 3}, ids);
  const auto second = latest_by_id({all.begin() + 3, all.end()}, ids);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    EXPECT_EQ((*first[i])["metrics"], (*second[i])["metrics"]);
    EXPECT_EQ((*first[i])["pictures"], (*second[i])["pictures"]);
    EXPECT_EQ((*first[i])["provenance"]["threads"], 1);
    EXPECT_EQ((*second[i])["provenance"]["threads"], 2);
  }
}

TEST_F(RunnerTest, ARefusalIsRecordedAndReused) {
  PlannedRun planned = make_run(1);
  planned.spec.periodic = false;
  Plan plan;
  plan.runs = {finish(planned)};
  EXPECT_EQ(run(plan).refused, 1U);
  EXPECT_EQ(run(plan).reused, 1U);
  ASSERT_EQ(records().size(), 1U);
  EXPECT_EQ(records()[0]["status"], "refused");
}

TEST_F(RunnerTest, AnExceptionIsAFailedRecordAndTriedAgain) {
  PlannedRun planned = make_run(1);
  planned.spec.pictures = {"sample_3"};
  Plan plan = make_small_plan(2);
  plan.runs.insert(plan.runs.begin(), finish(planned));
  const RunSummary summary = run(plan);
  EXPECT_EQ(summary.failed, 1U);
  EXPECT_EQ(summary.recorded, 2U) << "the others are not hurt";
  ASSERT_EQ(records().size(), 3U);
  EXPECT_THAT(records()[0]["reason"].get<std::string>(), HasSubstr("raise samples"));
  const RunSummary again = run(plan);
  EXPECT_EQ(again.failed, 1U);
  EXPECT_EQ(again.reused, 2U);
}

TEST_F(RunnerTest, ATimeoutIsAFailedRecord) {
  Plan plan = make_endless_plan();
  plan.runs[0].spec.timeout_seconds = 0.2;
  EXPECT_EQ(run(plan).failed, 1U);
  ASSERT_EQ(records().size(), 1U);
  EXPECT_EQ(records()[0]["id"], plan.runs[0].id);
  EXPECT_THAT(records()[0]["reason"].get<std::string>(), HasSubstr("no result within 0.2 s"));
}

TEST_F(RunnerTest, ACrashIsAFailedRecord) {
  const Plan plan = make_endless_plan();
  const Assassin assassin;
  EXPECT_EQ(run(plan).failed, 1U);
  ASSERT_EQ(records().size(), 1U);
  EXPECT_THAT(records()[0]["reason"].get<std::string>(), HasSubstr("killed by SIGKILL"));
}

TEST_F(RunnerTest, TellsDamagedLinesOfEarlierRecords) {
  std::ofstream(folder_.path() / "records.jsonl") << "{\"schema\":1,\"id\":\"cut";
  const RunSummary summary = run(make_small_plan(1));
  ASSERT_EQ(summary.bad_lines.size(), 1U);
  EXPECT_EQ(summary.bad_lines[0].line, 1U);
  EXPECT_EQ(records().size(), 1U);
}

TEST_F(RunnerTest, RefusesToRunWithoutJobsOrThreads) {
  EXPECT_THROW(run(make_small_plan(1), {.jobs = 0}), std::invalid_argument);
  EXPECT_THROW(run(make_small_plan(1), {.threads = 0}), std::invalid_argument);
}

}  // namespace textonbench::runner_test
