#include "experiments/runner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <list>
#include <set>
#include <thread>

#include "experiments/child_process.h"
#include "tests/temporary_folder.h"

namespace textonbench::runner_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::MatchesRegex;

// --- children ------------------------------------------------------------------------------------------------------

class ChildProcessTest : public testing::Test {
 protected:
  /// Runs `work` to its end.
  std::unique_ptr<ChildProcess> finish(const std::function<std::string()>& work,
                                       const ChildLimits& limits = {.seconds = 60}) const {
    auto child = std::make_unique<ChildProcess>(work, log(), limits);
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
  EXPECT_EQ(child->signal(), "SIGABRT");
  EXPECT_TRUE(std::filesystem::exists(log()));
}

TEST_F(ChildProcessTest, AnEndlessLoopIsCutAtItsTimeout) {
  const auto start = std::chrono::steady_clock::now();
  const auto child = finish(
      []() -> std::string {
        while (true) pause();
      },
      {.seconds = 0.05});
  EXPECT_EQ(child->signal(), "") << "the runner's own";
  EXPECT_THAT(child->failure(), HasSubstr("no result within 0.05 s"));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
}

TEST_F(ChildProcessTest, AnEarlyExitIsAFailureByItsStatus) {
  EXPECT_EQ(finish([]() -> std::string { _exit(3); })->failure(), "ended with status 3");
}

TEST_F(ChildProcessTest, AllocationWithoutEndIsOutOfMemory) {
  if (!enforces_memory_limits()) GTEST_SKIP() << "a build with a sanitizer has no memory limit";
  const auto child = finish(
      []() -> std::string {
        for (std::list<std::string> all;;) all.emplace_back(1 << 20, 'x');
      },
      {.seconds = 60, .memory_bytes = 256 << 20});
  EXPECT_EQ(child->failure(), "out of memory (memory_limit_mb = 256)");
}

TEST_F(ChildProcessTest, OutputWithoutEndIsCut) {
  const auto child = finish([] { return std::string(std::size_t{200} << 20, 'x'); });
  EXPECT_EQ(child->failure(), "sent more than 64 MiB where a record was expected");
  EXPECT_EQ(child->output(), "");
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
        log(), {.seconds = 60});
    ASSERT_EQ(read(ends[0], &pid, sizeof pid), static_cast<ssize_t>(sizeof pid));
    EXPECT_EQ(kill(pid, 0), 0);
    close(ends[0]);
    close(ends[1]);
  }
  EXPECT_EQ(kill(pid, 0), -1);
}

TEST_F(ChildProcessTest, OnlyTheRecordOfItsRunIsTakenForIt) {
  PlannedRun run;
  run.spec.method = "rpn";
  run.id = run_id(run.spec);
  const auto reason_after = [&](const std::string& sent) {
    const Record record = record_of(run, *finish([&] { return sent; }));
    EXPECT_EQ(record["id"], run.id);
    EXPECT_EQ(record["status"], "failed");
    return record["reason"].get<std::string>();
  };
  EXPECT_EQ(reason_after(""), "sent no record (not JSON (cut short?)) but 0 bytes: \"\"");
  EXPECT_THAT(reason_after("\xff\x01garbage"), AllOf(HasSubstr("not JSON"), HasSubstr("9 bytes: \"\xff\x01garbage")));
  EXPECT_THAT(reason_after("[1, 2]"), HasSubstr("not a JSON object"));
  EXPECT_THAT(reason_after("{\"schema\": 1, \"id\": \"x\"}"), HasSubstr("no text under \"status\""));
  EXPECT_EQ(reason_after(R"({"schema": 1, "id": "x", "status": "ok"})"), "sent the record of another run, \"x\"");
  const Record own = {{"schema", 1}, {"id", run.id}, {"status", "ok"}};
  EXPECT_EQ(record_of(run, *finish([&] { return own.dump(); })), own);
  const Record crash = record_of(run, *finish([]() -> std::string { std::abort(); }));
  EXPECT_EQ(crash["signal"], "SIGABRT");
  EXPECT_EQ(crash["metrics"], Record::object()) << "nothing measured is no zero";
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

/// Sends a signal to the runner's child as soon as it is at work; a process of its own, because the runner's must not
/// have threads.
class Assassin {
 public:
  explicit Assassin(int signal) {
    const pid_t parent = getpid();
    pid_ = fork();
    if (pid_ != 0) return;
    const std::string children = "/proc/" + std::to_string(parent) + "/task/" + std::to_string(parent) + "/children";
    while (true) {
      std::ifstream in(children);
      for (pid_t child = 0; in >> child;) {
        // Once its output goes to its log, it is at work.
        std::error_code gone;
        const auto output = std::filesystem::read_symlink("/proc/" + std::to_string(child) + "/fd/2", gone);
        if (child == getpid() || output.extension() != ".stderr") continue;
        kill(child, signal);
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
  const Assassin assassin(SIGKILL);
  EXPECT_EQ(run(plan).failed, 1U);
  ASSERT_EQ(records().size(), 1U);
  EXPECT_EQ(records()[0]["reason"], "killed by SIGKILL");
  EXPECT_EQ(records()[0]["signal"], "SIGKILL");
}

TEST_F(RunnerTest, WhatAFailedRunPrintedIsKeptUntilItSucceeds) {
  // The child inherits the handler: a run that says something before it ends.
  const auto previous = std::signal(SIGUSR1, [](int) {
    (void)!write(STDERR_FILENO, "a last word\n", 12);
    _exit(7);
  });
  Plan plan = make_endless_plan();
  {
    const Assassin assassin(SIGUSR1);
    EXPECT_EQ(run(plan).failed, 1U);
  }
  std::signal(SIGUSR1, previous);
  const std::string log = "logs/" + plan.runs[0].id + ".stderr";
  ASSERT_EQ(records().size(), 1U);
  EXPECT_EQ(records()[0]["reason"], "ended with status 7; its last words: a last word");
  EXPECT_EQ(records()[0]["log"], log);
  EXPECT_EQ(std::filesystem::file_size(folder_.path() / log), 12U);

  Plan quick = make_small_plan(1);
  std::filesystem::rename(folder_.path() / log, folder_.path() / ("logs/" + quick.runs[0].id + ".stderr"));
  EXPECT_EQ(run(quick).recorded, 1U);
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path() / "logs")) {
    EXPECT_EQ(entry.path().extension(), ".log") << entry.path();
  }
}

TEST_F(RunnerTest, ARunThatNeedsMoreMemoryThanItMayTakeFails) {
  if (!enforces_memory_limits()) GTEST_SKIP() << "a build with a sanitizer has no memory limit";
  Plan plan = make_small_plan(2);
  plan.runs[0].spec.samples = 100000;
  plan.runs[0].spec.memory_limit_mb = 256;
  plan.runs[0] = finish(plan.runs[0]);
  const RunSummary summary = run(plan);
  EXPECT_EQ(summary.failed, 1U);
  EXPECT_EQ(summary.recorded, 1U);
  EXPECT_EQ(records()[0]["reason"], "out of memory (memory_limit_mb = 256)");
}

TEST_F(RunnerTest, TheLogTellsStartFailuresAndEnd) {
  Plan plan = make_small_plan(2);
  plan.runs[0].spec.pictures = {"sample_3"};
  plan.runs[0] = finish(plan.runs[0]);
  run(plan);
  std::string log;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path() / "logs")) {
    EXPECT_THAT(entry.path().filename().string(), MatchesRegex("run-[0-9]{4}-[0-9]{2}-[0-9]{2}\\.log"));
    std::ifstream in(entry.path());
    log.append(std::istreambuf_iterator<char>(in), {});
  }
  EXPECT_THAT(log, AllOf(HasSubstr("start: 2 runs to make"), HasSubstr("failed: textonbench measure rpn"),
                         HasSubstr("raise samples"), HasSubstr("end: 2/2 runs, 1 failed in ")));
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
