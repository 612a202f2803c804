#include "experiments/merge.h"

#include <fmt/format.h>
#include <unistd.h>

#include <set>
#include <stdexcept>
#include <string>
#include <system_error>
#include <tuple>

#include "experiments/folder_lock.h"
#include "experiments/provenance.h"

namespace textonbench {
namespace {

using RecordKey = std::tuple<std::string, std::string, std::string>;

/// A record of another program may have anything there.
std::string member_text(const Record& record, const char* object, const char* key) {
  if (!record.contains(object) || !record[object].is_object()) return {};
  const Record& inner = record[object];
  return inner.contains(key) && inner[key].is_string() ? inner[key].get<std::string>() : std::string();
}

RecordKey key_of(const Record& record) {
  return {record["id"].get<std::string>(), record["status"].get<std::string>(),
          member_text(record, "time", "finished")};
}

enum class Copied { yes, present, missing };

/// Copies from/name, whose stem is the SHA-256 of its bytes, to to/name, which is there as a whole or not at all.
Copied copy_hashed(const std::filesystem::path& from, const std::filesystem::path& to,
                   const std::filesystem::path& name) {
  if (std::filesystem::exists(to / name)) return Copied::present;
  const std::filesystem::path folder = (to / name).parent_path();
  const std::filesystem::path draft = folder / fmt::format(".draft_{}_merge", ::getpid());
  std::error_code error;
  if (!std::filesystem::is_regular_file(from / name, error)) return Copied::missing;
  if (sha256_of_file(from / name) != name.stem().string()) return Copied::missing;
  std::filesystem::create_directories(folder, error);
  if (!error) std::filesystem::copy_file(from / name, draft, std::filesystem::copy_options::overwrite_existing, error);
  if (!error) std::filesystem::rename(draft, to / name, error);
  if (error) {
    std::error_code ignored;
    std::filesystem::remove(draft, ignored);
    throw std::runtime_error(fmt::format("{}: cannot be written: {}", (to / name).string(), error.message()));
  }
  return Copied::yes;
}

void copy_pictures(const Record& record, const std::filesystem::path& from, const std::filesystem::path& to,
                   MergeSummary& summary) {
  if (!record.contains("pictures") || !record["pictures"].is_object()) return;
  for (const auto& [name, picture] : record["pictures"].items()) {
    const std::filesystem::path file = member_text(record["pictures"], name.c_str(), "file");
    // Never out of the folder, whatever the record says.
    const bool is_proper = file.parent_path() == "pictures" && file.filename() != "..";
    const Copied copied = is_proper ? copy_hashed(from, to, file) : Copied::missing;
    if (copied == Copied::yes) ++summary.pictures_copied;
    if (copied == Copied::missing) ++summary.pictures_missing;
  }
}

}  // namespace

MergeSummary merge_records(const std::filesystem::path& source, const ResultsFolder& results) {
  MergeSummary summary{.file = std::filesystem::is_directory(source) ? source / "records.jsonl" : source};
  if (!std::filesystem::is_regular_file(summary.file)) {
    throw std::invalid_argument(
        fmt::format("{}: expected a records file, or a results folder with records.jsonl", source.string()));
  }
  const std::filesystem::path from = summary.file.parent_path();
  const FolderLock lock(results);
  std::set<RecordKey> known;
  for (const Record& record : results.read().records) known.insert(key_of(record));
  ReadRecords read = read_records(summary.file);
  summary.bad_lines = std::move(read.bad_lines);
  std::vector<Record> added;
  for (Record& record : read.records) {
    if (!known.insert(key_of(record)).second) {
      ++summary.present;
      continue;
    }
    copy_pictures(record, from, results.path(), summary);
    if (const std::string diff = member_text(record, "provenance", "git_diff");
        !diff.empty() && diff.find('/') == std::string::npos) {
      copy_hashed(from, results.path(), std::filesystem::path("provenance") / (diff + ".diff"));
    }
    record.erase("log");
    added.push_back(std::move(record));
  }
  results.append_all(added);
  summary.added = added.size();
  return summary;
}

}  // namespace textonbench
