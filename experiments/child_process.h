// Work done in a forked copy of this process, so that a crash or an endless loop costs that work alone.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>

namespace textonbench {

/// A running child. What its work returns comes back through a pipe; its standard output and error go to a file. The
/// child dies with its parent, and keeps the parent's signal mask: who blocks SIGINT decides for both.
class ChildProcess {
 public:
  using Clock = std::chrono::steady_clock;

  /// Forks. This process must not have started threads. Throws std::system_error when there is no process or
  /// descriptor left, or the log cannot be opened.
  ChildProcess(const std::function<std::string()>& work, std::filesystem::path log, double timeout_seconds);
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

 private:
  void finish();

  std::filesystem::path log_;
  double timeout_seconds_;
  Clock::time_point deadline_;
  pid_t pid_ = -1;
  int pipe_ = -1;
  bool timed_out_ = false;
  std::string output_, failure_;
};

}  // namespace textonbench
