#include "experiments/progress.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <ctime>
#include <utility>

namespace textonbench {
namespace {

constexpr auto plain_pause = std::chrono::milliseconds(5000);
constexpr const char* erase_line = "\r\x1b[K";

}  // namespace

std::string readable_duration(double seconds) {
  const long whole = std::lround(seconds);
  if (whole < 90) return fmt::format("{} s", whole);
  if (whole < 5400) return fmt::format("{} min", (whole + 30) / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

Progress::Progress(std::size_t total, std::string unit, bool show, const std::filesystem::path& log)
    : total_(total), unit_(std::move(unit)), show_(show && total > 0), terminal_(isatty(STDERR_FILENO) == 1) {
  if (!log.empty()) {
    log_.open(log, std::ios::app);
    if (!log_) fmt::print(stderr, "textonbench: warning: {}: cannot be written\n", log.string());
  }
  write_log(fmt::format("start: {} {} to make", total_, unit_));
  if (show_ && terminal_) print();
}

Progress::~Progress() {
  if (show_ && terminal_) fmt::print(stderr, "{}", erase_line);
  write_log(fmt::format("{}: {} in {:.1f} s", done_ < total_ ? "stopped" : "end", state(), seconds()));
}

double Progress::seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

void Progress::advance(const std::string& failure) {
  ++done_;
  if (!failure.empty()) {
    ++failed_;
    write_log("failed: " + failure);
    if (show_) fmt::print(stderr, "{}failed: {}\n", terminal_ ? erase_line : "", failure);
  }
  const Clock::time_point now = Clock::now();
  if (now - logged_ >= plain_pause) {
    logged_ = now;
    write_log(state());
  }
  if (show_ && now - printed_ >= (terminal_ ? std::chrono::milliseconds(100) : plain_pause)) print();
}

std::string Progress::state() const {
  std::string line = fmt::format("{}/{} {}", done_, total_, unit_);
  if (failed_ > 0) line += fmt::format(", {} failed", failed_);
  if (done_ > 0 && done_ < total_) {
    const double left = seconds() / static_cast<double>(done_) * static_cast<double>(total_ - done_);
    line += fmt::format(", about {} left", readable_duration(left));
  }
  return line;
}

void Progress::print() {
  printed_ = Clock::now();
  if (terminal_) {
    fmt::print(stderr, "{}{}", erase_line, state());
  } else {
    fmt::print(stderr, "{}\n", state());
  }
}

StatusLine::StatusLine(bool show) : show_(show), terminal_(isatty(STDERR_FILENO) == 1) {}

StatusLine::~StatusLine() { erase(); }

bool StatusLine::due() const { return show_ && Clock::now() >= next_; }

void StatusLine::tell(const std::string& text) {
  if (!due()) return;
  next_ = Clock::now() + (terminal_ ? std::chrono::milliseconds(100) : plain_pause);
  standing_ = terminal_;
  if (terminal_) {
    fmt::print(stderr, "{}{}", erase_line, text);
  } else {
    fmt::print(stderr, "{}\n", text);
  }
}

void StatusLine::erase() {
  if (standing_) fmt::print(stderr, "{}", erase_line);
  standing_ = false;
}

void Progress::write_log(const std::string& text) {
  log_ << fmt::format("{:%Y-%m-%dT%H:%M:%SZ} [{}] {}\n", fmt::gmtime(std::time(nullptr)), getpid(), text) << std::flush;
}

}  // namespace textonbench
