#include "experiments/folder_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <vector>

namespace textonbench {
namespace {

void remove_drafts(const std::filesystem::path& folder) {
  std::error_code ignored;
  std::vector<std::filesystem::path> drafts;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    if (entry.path().filename().string().starts_with(".draft_")) drafts.push_back(entry.path());
  }
  for (const std::filesystem::path& draft : drafts) std::filesystem::remove(draft, ignored);
}

}  // namespace

FolderLock::FolderLock(const ResultsFolder& results) {
  const std::filesystem::path path = results.path() / ".lock";
  descriptor_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor_ < 0) {
    throw std::runtime_error(
        fmt::format("{}: cannot be opened: {}", path.string(), std::generic_category().message(errno)));
  }
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) {
    for (const char* folder : {"pictures", "logs", "provenance"}) remove_drafts(results.path() / folder);
  }
  while (::flock(descriptor_, LOCK_SH) != 0 && errno == EINTR) continue;
}

FolderLock::~FolderLock() { ::close(descriptor_); }

}  // namespace textonbench
