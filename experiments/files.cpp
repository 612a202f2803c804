#include "experiments/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <system_error>

namespace textonbench {
namespace {

/// Zero or the error number.
int write_and_sync(const std::filesystem::path& file, std::string_view text) {
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) return errno;
  int error = 0;
  while (!text.empty() && error == 0) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno != EINTR) error = errno;
    if (written > 0) text.remove_prefix(static_cast<std::size_t>(written));
  }
  if (error == 0 && ::fsync(descriptor) != 0) error = errno;
  if (::close(descriptor) != 0 && error == 0) error = errno;
  return error;
}

}  // namespace

std::string read_file(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream || !std::filesystem::is_regular_file(file)) {
    throw std::runtime_error(fmt::format("{}: cannot be read", file.string()));
  }
  return {std::istreambuf_iterator<char>(stream), {}};
}

void write_atomically(const std::filesystem::path& file, std::string_view text) {
  const std::filesystem::path draft =
      file.parent_path() / fmt::format(".draft_{}_{}", ::getpid(), file.filename().string());
  std::error_code error(write_and_sync(draft, text), std::generic_category());
  if (!error) std::filesystem::rename(draft, file, error);
  if (!error) return;
  std::error_code ignored;
  std::filesystem::remove(draft, ignored);
  throw std::runtime_error(
      fmt::format("{}: cannot be written (what was there is kept): {}", file.string(), error.message()));
}

std::filesystem::path with_suffix(const std::filesystem::path& stem, std::string_view suffix) {
  std::filesystem::path path = stem;
  return path += suffix;
}

}  // namespace textonbench
