#include "experiments/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

namespace textonbench {
namespace {

std::string readable_duration(double seconds) {
  const long whole = std::lround(seconds);
  if (whole < 90) return fmt::format("{} s", whole);
  if (whole < 5400) return fmt::format("{} min", (whole + 30) / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

constexpr const char* erase_line = "\r\x1b[K";

}  // namespace

Progress::Progress(std::size_t total, bool show)
    : total_(total), show_(show && total > 0), terminal_(isatty(STDERR_FILENO) == 1) {
  if (show_ && terminal_) print();
}

Progress::~Progress() {
  if (show_ && terminal_) fmt::print(stderr, "{}", erase_line);
}

double Progress::seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

void Progress::advance(const std::string& failure) {
  ++done_;
  if (!failure.empty()) ++failed_;
  if (!show_) return;
  if (!failure.empty()) fmt::print(stderr, "{}failed: {}\n", terminal_ ? erase_line : "", failure);
  const auto pause = terminal_ ? std::chrono::milliseconds(100) : std::chrono::milliseconds(5000);
  if (Clock::now() - printed_ >= pause) print();
}

void Progress::print() {
  printed_ = Clock::now();
  std::string line = fmt::format("{}/{} runs", done_, total_);
  if (failed_ > 0) line += fmt::format(", {} failed", failed_);
  if (done_ > 0) {
    const double left = seconds() / static_cast<double>(done_) * static_cast<double>(total_ - done_);
    line += fmt::format(", about {} left", readable_duration(left));
  }
  if (terminal_) {
    fmt::print(stderr, "{}{}", erase_line, line);
  } else {
    fmt::print(stderr, "{}\n", line);
  }
}

}  // namespace textonbench
