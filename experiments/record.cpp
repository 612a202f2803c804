#include "experiments/record.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <map>
#include <stdexcept>
#include <system_error>

#include "experiments/files.h"
#include "experiments/provenance.h"

namespace textonbench {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& what, int error) {
  throw std::runtime_error(fmt::format("{}: {}: {}", path.string(), what, std::generic_category().message(error)));
}

/// An open file under an advisory lock; closing it releases the lock.
class LockedFile {
 public:
  LockedFile(const std::filesystem::path& path, int flags, int lock)
      : path_(path), descriptor_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {
    if (descriptor_ < 0) fail(path_, "cannot be opened", errno);
    while (::flock(descriptor_, lock) != 0) {
      if (errno == EINTR) continue;
      const int error = errno;
      ::close(descriptor_);
      fail(path_, "cannot be locked", error);
    }
  }
  LockedFile(const LockedFile&) = delete;
  LockedFile& operator=(const LockedFile&) = delete;
  ~LockedFile() { ::close(descriptor_); }

  int descriptor() const { return descriptor_; }
  off_t size() const {
    struct stat status {};
    if (::fstat(descriptor_, &status) != 0) fail(path_, "cannot be examined", errno);
    return status.st_size;
  }

 private:
  std::filesystem::path path_;
  int descriptor_;
};

/// Writes and syncs; returns 0 or the error number. One write does it, unless the medium takes only a part: the next
/// one then tells why.
int write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno != EINTR) return errno;
    if (written > 0) bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return ::fsync(descriptor) == 0 ? 0 : errno;
}

int rank_of(const Record& record) {
  const std::string status = record.value("status", "");
  return status == "ok" ? 2 : status == "failed" ? 0 : 1;
}

}  // namespace

bool stands_for(const Record& later, const Record& earlier) { return rank_of(later) >= rank_of(earlier); }

std::optional<std::string> record_defect(const Record& json) {
  if (json.is_discarded()) return "not JSON (cut short?)";
  if (!json.is_object()) return "not a JSON object";
  if (!json.contains("schema") || json["schema"] != 1) return "expected \"schema\": 1";
  for (const char* key : {"id", "status"}) {
    if (!json.contains(key) || !json[key].is_string()) return fmt::format("no text under \"{}\"", key);
  }
  return std::nullopt;
}

ResultsFolder::ResultsFolder(std::filesystem::path folder) : folder_(std::move(folder)) {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) {
    throw std::runtime_error(
        fmt::format("{}: the results folder cannot be created: {}", folder_.string(), error.message()));
  }
  if (::access(folder_.c_str(), W_OK | X_OK) != 0) fail(folder_, "the results folder cannot be written", errno);
}

void ResultsFolder::append(const Record& record) const { append_all(std::vector<Record>{record}); }

void ResultsFolder::append_all(const std::vector<Record>& records) const {
  if (records.empty()) return;
  const std::filesystem::path path = folder_ / "records.jsonl";
  const LockedFile file(path, O_RDWR | O_APPEND | O_CREAT, LOCK_EX);
  const off_t size = file.size();
  // A line that a crash cut short is ended first, so that it cannot swallow this record.
  char last = '\n';
  if (size > 0 && ::pread(file.descriptor(), &last, 1, size - 1) != 1) fail(path, "cannot be read", errno);
  std::string text = last == '\n' ? "" : "\n";
  for (const Record& record : records) {
    // A reason may quote what a crashed child printed, which need not be UTF-8.
    text += record.dump(-1, ' ', false, Record::error_handler_t::replace) + "\n";
  }
  const int error = write_all(file.descriptor(), text);
  if (error == 0) return;
  if (::ftruncate(file.descriptor(), size) != 0) fail(path, "cannot be restored after a failed append", errno);
  fail(path, "a record cannot be appended (earlier records are kept)", error);
}

ReadRecords read_records(const std::filesystem::path& path) {
  ReadRecords result;
  if (!std::filesystem::exists(path)) return result;
  const LockedFile lock(path, O_RDONLY, LOCK_SH);
  std::ifstream in(path, std::ios::binary);
  std::size_t number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    Record json = Record::parse(line, nullptr, /*allow_exceptions=*/false);
    if (std::optional<std::string> reason = record_defect(json)) {
      result.bad_lines.push_back({number, *std::move(reason)});
    } else {
      result.records.push_back(std::move(json));
    }
  }
  if (in.bad()) throw std::runtime_error(fmt::format("{}: cannot be read", path.string()));
  return result;
}

std::string ResultsFolder::keep_picture(const std::filesystem::path& file) const {
  std::string name = "pictures/" + sha256_of_file(file) + file.extension().string();
  std::error_code error;
  std::filesystem::create_directories(folder_ / "pictures", error);
  if (!error) std::filesystem::rename(file, folder_ / name, error);
  if (error) {
    throw std::runtime_error(
        fmt::format("{}: the picture cannot be kept: {}", (folder_ / name).string(), error.message()));
  }
  return name;
}

void ResultsFolder::keep_text(const std::filesystem::path& name, const std::string& text) const {
  const std::filesystem::path file = folder_ / name;
  if (std::filesystem::exists(file)) return;
  std::error_code error;
  std::filesystem::create_directories(file.parent_path(), error);
  if (error) throw std::runtime_error(fmt::format("{}: cannot be written: {}", file.string(), error.message()));
  write_atomically(file, text);
}

std::vector<std::optional<Record>> latest_by_id(const std::vector<Record>& records,
                                                const std::vector<std::string>& ids) {
  std::map<std::string, const Record*> latest;
  for (const Record& record : records) {
    const Record*& kept = latest[record["id"].get<std::string>()];
    if (kept == nullptr || stands_for(record, *kept)) kept = &record;
  }
  std::vector<std::optional<Record>> result;
  result.reserve(ids.size());
  for (const std::string& id : ids) {
    const auto found = latest.find(id);
    result.push_back(found == latest.end() ? std::nullopt : std::optional<Record>(*found->second));
  }
  return result;
}

}  // namespace textonbench
