// How far a long piece of work is: on standard error, and in a log file.
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>

namespace textonbench {

/// "40 s", "12 min", "3.5 h".
std::string readable_duration(double seconds);

/// On a terminal one line that is rewritten; elsewhere, and in the log, a plain line every few seconds. Lines of the
/// log begin with the time and the process, since several may share it.
class Progress {
 public:
  /// `unit`: what is counted, in the plural: "runs". Appends to `log`, if it is not empty, from then on. A log that
  /// cannot be written is told once and is no reason to stop.
  Progress(std::size_t total, std::string unit, bool show, const std::filesystem::path& log);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();

  /// One more is done. `failure` is told at once, on a line of its own, when it is not empty.
  void advance(const std::string& failure);
  /// Of a clock that nobody sets.
  double seconds() const;

 private:
  using Clock = std::chrono::steady_clock;

  std::string state() const;
  void print();
  void write_log(const std::string& text);

  std::size_t total_, done_ = 0, failed_ = 0;
  std::string unit_;
  bool show_, terminal_;
  std::ofstream log_;
  Clock::time_point start_ = Clock::now(), printed_ = start_, logged_ = start_;
};

/// What a piece of work of unknown length is at: nothing in the first two seconds, then on a terminal one line that is
/// rewritten, elsewhere a plain line every few seconds. On standard error.
class StatusLine {
 public:
  explicit StatusLine(bool show);
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;
  ~StatusLine();

  /// True when a line told now would be printed.
  bool due() const;
  void tell(const std::string& text);
  /// Leaves the place to other lines.
  void erase();

 private:
  using Clock = std::chrono::steady_clock;

  bool show_, terminal_, standing_ = false;
  Clock::time_point next_ = Clock::now() + std::chrono::seconds(2);
};

}  // namespace textonbench
