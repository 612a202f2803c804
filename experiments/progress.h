// How far a long piece of work is, on standard error.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace textonbench {

/// On a terminal one line that is rewritten; elsewhere (a log) a plain line every few seconds.
class Progress {
 public:
  Progress(std::size_t total, bool show);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();

  /// One more is done. `failure` is told at once, on a line of its own, when it is not empty.
  void advance(const std::string& failure);
  double seconds() const;

 private:
  void print();

  using Clock = std::chrono::steady_clock;
  std::size_t total_, done_ = 0, failed_ = 0;
  bool show_, terminal_;
  Clock::time_point start_ = Clock::now(), printed_ = start_;
};

}  // namespace textonbench
