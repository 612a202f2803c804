#include "experiments/runner.h"

#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>
#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <deque>
#include <list>
#include <stdexcept>
#include <system_error>

#include "experiments/child_process.h"
#include "experiments/execute.h"
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
    record = execute(spec, exemplars.find(spec.exemplar), &results);
  } catch (const std::exception& error) {
    record = unsuccessful_record(spec, "failed", error.what());
  }
  return record.dump(-1, ' ', false, Record::error_handler_t::replace);
}

struct Running {
  Running(const PlannedRun& planned, const ExemplarCatalog& exemplars, const ResultsFolder& results, int threads)
      : run(planned),
        child([&] { return work(planned.spec, exemplars, results, threads); },
              results.path() / "logs" / (planned.id + ".stderr"), planned.spec.timeout_seconds) {}

  Record record() const {
    if (!child.failure().empty()) return unsuccessful_record(run.spec, "failed", child.failure());
    Record sent = Record::parse(child.output(), nullptr, /*allow_exceptions=*/false);
    return sent.is_object() ? sent : unsuccessful_record(run.spec, "failed", "ended without a result");
  }

  const PlannedRun& run;
  ChildProcess child;
};

/// Waits until a child has something to say, a deadline passes or a signal comes.
void wait_for_news(const StopSignals& stop, const std::list<Running>& running) {
  std::vector<pollfd> watched{{stop.descriptor(), POLLIN, 0}};
  auto deadline = ChildProcess::Clock::time_point::max();
  for (const Running& r : running) {
    watched.push_back({r.child.descriptor(), POLLIN, 0});
    deadline = std::min(deadline, r.child.deadline());
  }
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - ChildProcess::Clock::now()).count();
  constexpr long long longest = 3'600'000;
  poll(watched.data(), watched.size(), static_cast<int>(std::clamp<long long>(left, 0, longest)));
}

}  // namespace

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

  std::vector<std::string> ids;
  for (const PlannedRun& run : plan.runs) ids.push_back(run.id);
  const std::vector<std::optional<Record>> recorded = latest_by_id(earlier.records, ids);
  std::deque<const PlannedRun*> pending;
  for (std::size_t i = 0; i < plan.runs.size(); ++i) {
    const bool reusable = recorded[i] && (*recorded[i])["status"] != "failed";
    if (reusable && !options.fresh) {
      ++summary.reused;
    } else {
      pending.push_back(&plan.runs[i]);
    }
  }

  std::filesystem::create_directories(results.path() / "logs");
  // Looked up here once, and inherited by every child.
  provenance();
  Progress progress(pending.size(), options.show_progress);
  const StopSignals stop;
  std::list<Running> running;
  while (!pending.empty() || !running.empty()) {
    while (!pending.empty() && std::ssize(running) < options.jobs) {
      running.emplace_back(*pending.front(), exemplars, results, options.threads);
      pending.pop_front();
    }
    wait_for_news(stop, running);
    if (stop.received()) {
      *interrupted = true;
      break;
    }
    for (auto r = running.begin(); r != running.end();) {
      if (!r->child.receive()) {
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
