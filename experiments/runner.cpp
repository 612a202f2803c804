#include "experiments/runner.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>
#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <ctime>
#include <deque>
#include <list>
#include <new>
#include <stdexcept>
#include <system_error>

#include "experiments/child_process.h"
#include "experiments/execute.h"
#include "experiments/folder_lock.h"
#include "experiments/gpu_run.h"
#include "experiments/history.h"
#include "experiments/progress.h"
#include "experiments/provenance.h"

namespace textonbench {
namespace {

/// SIGINT and SIGTERM as something to poll, for as long as this lives.
class StopSignals {
 public:
  StopSignals() {
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGINT);
    sigaddset(&signals, SIGTERM);
    sigprocmask(SIG_BLOCK, &signals, &previous_);
    descriptor_ = signalfd(-1, &signals, SFD_CLOEXEC | SFD_NONBLOCK);
    if (descriptor_ < 0) {
      const int error = errno;
      sigprocmask(SIG_SETMASK, &previous_, nullptr);
      throw std::system_error(error, std::generic_category(), "signalfd");
    }
  }
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;
  ~StopSignals() {
    close(descriptor_);
    sigprocmask(SIG_SETMASK, &previous_, nullptr);
  }

  int descriptor() const { return descriptor_; }
  /// Whether one has come; takes it, so that it does not strike when it is unblocked.
  bool received() const {
    signalfd_siginfo info;
    return read(descriptor_, &info, sizeof info) == sizeof info;
  }

 private:
  sigset_t previous_;
  int descriptor_ = -1;
};

/// What a child does. Its record tells an exception; whatever else happens to it, the parent tells.
std::string work(const RunSpec& spec, const ExemplarCatalog& exemplars, const ResultsFolder& results, int threads) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  Record record;
  try {
    record = execute_run(spec, exemplars, &results);
  } catch (const std::bad_alloc&) {
    throw;  // there may be no memory for a record
  } catch (const std::exception& error) {
    record = unsuccessful_record(spec, "failed", error.what());
  }
  return record.dump(-1, ' ', false, Record::error_handler_t::replace);
}

/// What a run may take, in bytes: three quarters of the machine's memory, shared by the children. 0, no limit, beside
/// the driver of a graphics processor, which may set aside far more than it uses.
std::int64_t memory_limit(const RunSpec& spec, int jobs) {
  if (spec.memory_limit_mb > 0) return std::int64_t{spec.memory_limit_mb} << 20;
  if (!spec.gpu.empty()) return 0;
  return std::int64_t{sysconf(_SC_PHYS_PAGES)} * sysconf(_SC_PAGESIZE) / 4 * 3 / jobs;
}

class Running {
 public:
  Running(const PlannedRun& planned, const ExemplarCatalog& exemplars, const ResultsFolder& results,
          const RunOptions& options)
      : run_(planned),
        results_(results),
        child_([&] { return work(planned.spec, exemplars, results, options.threads); },
               results.path() / "logs" / fmt::format(".draft_{}_{}.stderr", getpid(), planned.id),
               {.seconds = planned.spec.timeout_seconds, .memory_bytes = memory_limit(planned.spec, options.jobs)}) {}
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;
  ~Running() { std::filesystem::remove(child_.log(), ignored_); }

  bool draws_on_gpu() const { return !run_.spec.gpu.empty(); }
  ChildProcess& child() { return child_; }
  const ChildProcess& child() const { return child_; }

  /// Of the child that has ended. What a failed one printed stays in the folder, that of a success does not.
  Record record() const {
    Record record = record_of(run_, child_);
    const std::string log = "logs/" + run_.id + ".stderr";
    if (record["status"] != "failed") {
      std::filesystem::remove(results_.path() / log, ignored_);
    } else if (std::filesystem::exists(child_.log())) {
      std::filesystem::rename(child_.log(), results_.path() / log);
      record["log"] = log;
    }
    return record;
  }

 private:
  const PlannedRun& run_;
  const ResultsFolder& results_;
  ChildProcess child_;
  mutable std::error_code ignored_;
};

/// Waits until a child has something to say, a deadline passes or a signal comes.
void wait_for_news(const StopSignals& stop, const std::list<Running>& running) {
  std::vector<pollfd> watched{{stop.descriptor(), POLLIN, 0}};
  auto deadline = ChildProcess::Clock::time_point::max();
  for (const Running& r : running) {
    watched.push_back({r.child().descriptor(), POLLIN, 0});
    deadline = std::min(deadline, r.child().deadline());
  }
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - ChildProcess::Clock::now()).count();
  constexpr long long longest = 3'600'000;
  poll(watched.data(), watched.size(), static_cast<int>(std::clamp<long long>(left, 0, longest)));
}

/// One a day.
std::filesystem::path log_file(const ResultsFolder& results) {
  return results.path() / "logs" / fmt::format("run-{:%Y-%m-%d}.log", fmt::gmtime(std::time(nullptr)));
}

}  // namespace

Record record_of(const PlannedRun& run, const ChildProcess& child) {
  const auto failed = [&](const std::string& reason) { return unsuccessful_record(run.spec, "failed", reason); };
  if (!child.failure().empty()) {
    Record record = failed(child.failure());
    if (!child.signal().empty()) record["signal"] = child.signal();
    return record;
  }
  Record sent = Record::parse(child.output(), nullptr, /*allow_exceptions=*/false);
  if (const std::optional<std::string> defect = record_defect(sent)) {
    constexpr std::size_t shown = 80;
    return failed(fmt::format("sent no record ({}) but {} bytes: \"{}\"", *defect, child.output().size(),
                              child.output().substr(0, shown)));
  }
  if (sent["id"] != run.id) return failed(fmt::format("sent the record of another run, {}", sent["id"].dump()));
  return sent;
}

RunSummary run_plan(const Plan& plan, const ExemplarCatalog& exemplars, const ResultsFolder& results,
                    const RunOptions& options, bool* interrupted) {
  if (options.jobs < 1 || options.threads < 1) {
    throw std::invalid_argument(
        fmt::format("jobs = {}, threads = {}: expected at least 1", options.jobs, options.threads));
  }
  *interrupted = false;
  RunSummary summary;
  summary.planned = plan.runs.size();
  ReadRecords earlier = results.read();
  summary.bad_lines = std::move(earlier.bad_lines);

  const History history(earlier.records);
  earlier.records.clear();

  std::deque<const PlannedRun*> pending;
  for (const PlannedRun& run : plan.runs) {
    if (!options.fresh && history.is_reusable(run.id)) {
      ++summary.reused;
    } else {
      pending.push_back(&run);
    }
  }

  const FolderLock lock(results);
  std::filesystem::create_directories(results.path() / "logs");
  if (const std::string diff = source_diff(); !diff.empty()) {
    results.keep_text("provenance/" + sha256(diff) + ".diff", diff);
  }
  // Looked up here once, and inherited by every child.
  provenance();
  Progress progress(pending.size(), "runs", options.show_progress, log_file(results));
  const StopSignals stop;
  std::list<Running> running;
  while (!pending.empty() || !running.empty()) {
    while (!pending.empty() && std::ssize(running) < options.jobs) {
      // Two at once would share the graphics processor, and both their times would be wrong.
      if (!pending.front()->spec.gpu.empty() && std::ranges::any_of(running, &Running::draws_on_gpu)) break;
      running.emplace_back(*pending.front(), exemplars, results, options);
      pending.pop_front();
    }
    wait_for_news(stop, running);
    if (stop.received()) {
      *interrupted = true;
      break;
    }
    for (auto r = running.begin(); r != running.end();) {
      if (!r->child().receive()) {
        ++r;
        continue;
      }
      const Record record = r->record();
      results.append(record);
      const std::string status = record["status"];
      ++(status == "ok" ? summary.recorded : status == "refused" ? summary.refused : summary.failed);
      progress.advance(status == "failed" ? fmt::format("{}: {}", record["command"].get<std::string>(),
                                                        record["reason"].get<std::string>())
                                          : "");
      r = running.erase(r);
    }
  }
  summary.seconds = progress.seconds();
  return summary;
}

}  // namespace textonbench
