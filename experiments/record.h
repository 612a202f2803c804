// What a run leaves behind: one line of JSON. The only file format of results.
//
// A results folder holds records.jsonl (append-only, one record a line), pictures/ and provenance/ (files named by the
// SHA-256 of their bytes) and logs/. Writers append under a file lock with one write and fsync, so a crash, a full disk
// or a second process cannot damage a record that is already there; a line cut short by a crash is told and skipped.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace textonbench {

/// Keys: schema (1), id, status ("ok" | "failed" | "refused"), reason (unless ok), signal (when one
/// ended it: "SIGSEGV"), log (file of what it printed, when it failed and printed), spec (see run_spec.h), command,
/// exemplar {width, height, channels}, metrics {NAME: {value, stderr, unit, floor}} (stderr and floor null where they
/// do not exist), pictures {NAME: {file, width, height}} (file relative to the results folder), time {wall_seconds,
/// cpu_seconds, peak_bytes, finished (ISO 8601)}, provenance (see provenance.h). Of samples drawn on a graphics
/// processor also provenance.gpu and, when it was timed, timing (see gpu_run.h).
using Record = nlohmann::ordered_json;

/// A line of records.jsonl that could not be used.
struct BadLine {
  std::size_t line;
  std::string reason;
};

/// Whether, of two records with one id, the one that was recorded later stands for both: it does, but for a failure
/// after anything else and a refusal after a success (on a machine without a graphics processor, say).
bool stands_for(const Record& later, const Record& earlier);

/// Why a JSON value is no record, or nothing.
std::optional<std::string> record_defect(const Record& json);

struct ReadRecords {
  std::vector<Record> records;     ///< in file order
  std::vector<BadLine> bad_lines;  ///< kept in the file, told to the user
};

/// All records of a file. A missing file is no record.
ReadRecords read_records(const std::filesystem::path& file);

class ResultsFolder {
 public:
  /// Creates the folder if need be. Throws std::runtime_error naming it when it cannot be created or written.
  explicit ResultsFolder(std::filesystem::path folder);
  const std::filesystem::path& path() const { return folder_; }

  /// Appends one record, or several at once. Throws std::runtime_error (disk full, …); the file is then as it was
  /// before.
  void append(const Record& record) const;
  void append_all(const std::vector<Record>& records) const;
  ReadRecords read() const { return read_records(folder_ / "records.jsonl"); }
  /// Stores the bytes of `file` as pictures/<sha256>.<ext> (moving it) and returns that relative path.
  std::string keep_picture(const std::filesystem::path& file) const;
  /// Writes a text under that relative path unless there is such a file already.
  void keep_text(const std::filesystem::path& name, const std::string& text) const;

 private:
  std::filesystem::path folder_;
};

/// The last usable record of each id, in the order of `ids`; an empty optional where there is none.
std::vector<std::optional<Record>> latest_by_id(const std::vector<Record>& records,
                                                const std::vector<std::string>& ids);

}  // namespace textonbench
