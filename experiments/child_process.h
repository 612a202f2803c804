// Work done in a forked copy of this process, so that a crash or an endless loop costs that work alone.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace textonbench {

/// What a child may take before it is stopped.
struct ChildLimits {
  double seconds = 300;
  /// Of private memory (RLIMIT_DATA), what it inherits from its parent included; 0: no limit. Not enforced in builds
  /// with a sanitizer, whose shadow memory is larger than any machine's.
  std::int64_t memory_bytes = 0;
};

/// Whether this build can hold a child to `memory_bytes`.
bool enforces_memory_limits();

/// A running child. What its work returns comes back through a pipe; its standard output and error go to a file. The
/// child dies with its parent, and keeps the parent's signal mask: who blocks SIGINT decides for both.
class ChildProcess {
 public:
  using Clock = std::chrono::steady_clock;

  /// Forks. This process must not have started threads. Throws std::system_error when there is no process or
  /// descriptor left, or the log cannot be opened.
  ChildProcess(const std::function<std::string()>& work, std::filesystem::path log, const ChildLimits& limits);
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;
  /// Kills the child if it still runs.
  ~ChildProcess();

  /// Readable, for poll(), when receive() has something to do.
  int descriptor() const { return pipe_; }
  Clock::time_point deadline() const { return deadline_; }

  /// Reads what the child has sent; kills it past its deadline. True once it has ended.
  bool receive();

  /// After the end: what the work returned, …
  const std::string& output() const { return output_; }
  /// … and why it did not return ("killed by SIGSEGV"), with the last lines of its log; empty when it did.
  const std::string& failure() const { return failure_; }
  /// The signal that ended it ("SIGSEGV"); empty when none did, or only ours at the deadline.
  const std::string& signal() const { return signal_; }
  const std::filesystem::path& log() const { return log_; }

 private:
  void stop(const std::string& reason);
  void finish();

  std::filesystem::path log_;
  ChildLimits limits_;
  Clock::time_point deadline_;
  pid_t pid_ = -1;
  int pipe_ = -1;
  std::string stopped_;  ///< why we killed it
  std::string output_, failure_, signal_;
};

}  // namespace textonbench
