#include "experiments/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <new>
#include <system_error>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define TEXTONBENCH_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define TEXTONBENCH_SANITIZED 1
#endif
#endif

namespace textonbench {
namespace {

#ifdef TEXTONBENCH_SANITIZED
constexpr bool limits_memory = false;
#else
constexpr bool limits_memory = true;
#endif

/// Exit status of a child whose allocation failed.
constexpr int out_of_memory = 99;

/// A result is some kilobytes; a child that sends more than this has gone astray.
constexpr std::size_t longest_output = std::size_t{64} << 20;

[[noreturn]] void fail(const std::string& what) { throw std::system_error(errno, std::generic_category(), what); }

/// Body of the child; leaves without running the destructors and exit handlers that belong to the parent.
[[noreturn]] void run_child(const std::function<std::string()>& work, pid_t parent, int log, int pipe,
                            std::int64_t memory_bytes) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(EXIT_FAILURE);
  dup2(log, STDOUT_FILENO);
  dup2(log, STDERR_FILENO);
  if (limits_memory && memory_bytes > 0) {
    const auto bytes = static_cast<rlim_t>(memory_bytes);
    const rlimit limit{bytes, bytes};
    setrlimit(RLIMIT_DATA, &limit);
  }
  std::string result;
  try {
    result = work();
  } catch (const std::bad_alloc&) {
    _exit(out_of_memory);
  }
  for (std::size_t sent = 0; sent < result.size();) {
    const ssize_t written = write(pipe, result.data() + sent, result.size() - sent);
    if (written < 0 && errno != EINTR) _exit(EXIT_FAILURE);
    if (written > 0) sent += static_cast<std::size_t>(written);
  }
  _exit(EXIT_SUCCESS);
}

/// The last three lines of a file, at most 500 bytes.
std::string last_lines(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  in.seekg(0, std::ios::end);
  const std::streamoff size = in.tellg();
  if (size <= 0) return {};
  in.seekg(std::max<std::streamoff>(0, size - 500));
  std::string tail{std::istreambuf_iterator<char>(in), {}};
  while (!tail.empty() && tail.back() == '\n') tail.pop_back();
  std::size_t start = tail.size();
  for (int line = 0; line < 3 && start != std::string::npos && start > 0; ++line) start = tail.rfind('\n', start - 1);
  return start == std::string::npos ? tail : tail.substr(std::min(start + 1, tail.size()));
}

}  // namespace

bool enforces_memory_limits() { return limits_memory; }

ChildProcess::ChildProcess(const std::function<std::string()>& work, std::filesystem::path log,
                           const ChildLimits& limits)
    : log_(std::move(log)), limits_(limits) {
  // A year stands for "no limit": longer ones overflow the clock.
  constexpr double year = 3.2e7;
  deadline_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                 std::chrono::duration<double>(std::min(limits.seconds, year)));
  const int log_descriptor = open(log_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (log_descriptor < 0) fail(log_.string());
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) {
    close(log_descriptor);
    fail("pipe to a child process");
  }
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ == 0) run_child(work, parent, log_descriptor, ends[1], limits.memory_bytes);
  const int fork_error = errno;
  close(log_descriptor);
  close(ends[1]);
  pipe_ = ends[0];
  fcntl(pipe_, F_SETFL, O_NONBLOCK);
  if (pid_ < 0) {
    close(pipe_);
    errno = fork_error;
    fail("a child process");
  }
}

ChildProcess::~ChildProcess() {
  if (pid_ > 0) {
    kill(pid_, SIGKILL);
    while (waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) continue;
  }
  close(pipe_);
}

bool ChildProcess::receive() {
  if (Clock::now() >= deadline_) stop(fmt::format("no result within {} s (timeout_seconds)", limits_.seconds));
  std::array<char, 65536> buffer;
  const ssize_t count = read(pipe_, buffer.data(), buffer.size());
  if (count > 0 && stopped_.empty()) output_.append(buffer.data(), static_cast<std::size_t>(count));
  if (output_.size() > longest_output) {
    stop(fmt::format("sent more than {} MiB where a record was expected", longest_output >> 20));
    output_.clear();
  }
  if (count != 0) return false;
  finish();
  return true;
}

void ChildProcess::stop(const std::string& reason) {
  stopped_ = reason;
  deadline_ = Clock::time_point::max();
  kill(pid_, SIGKILL);
}

void ChildProcess::finish() {
  int status = 0;
  while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) continue;
  pid_ = -1;
  if (!stopped_.empty()) {
    failure_ = stopped_;
  } else if (WIFSIGNALED(status)) {
    signal_ = fmt::format("SIG{}", sigabbrev_np(WTERMSIG(status)));
    failure_ = "killed by " + signal_;
  } else if (WEXITSTATUS(status) == out_of_memory) {
    failure_ = "out of memory";
    if (limits_.memory_bytes > 0) failure_ += fmt::format(" (memory_limit_mb = {})", limits_.memory_bytes >> 20);
  } else if (WEXITSTATUS(status) != EXIT_SUCCESS) {
    failure_ = fmt::format("ended with status {}", WEXITSTATUS(status));
  }
  if (!failure_.empty()) {
    const std::string said = last_lines(log_);
    if (!said.empty()) failure_ += "; its last words: " + said;
  }
  std::error_code ignored;
  if (std::filesystem::file_size(log_, ignored) == 0) std::filesystem::remove(log_, ignored);
}

}  // namespace textonbench
