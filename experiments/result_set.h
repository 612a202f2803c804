// A set of records to compare or to keep: what was computed, whatever code computed it.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/record.h"

namespace textonbench {

/// The schema of the records that this program writes and reads.
constexpr int record_schema = 1;

struct ResultSet {
  std::filesystem::path file;
  /// By computation(): of several records of one computation the last that did not fail, or the last.
  std::map<std::string, Record> runs;
  std::vector<BadLine> bad_lines;  ///< left out
};

/// What a record computes, apart from the code: JSON text of its spec (method, params, exemplar and its SHA-256, size,
/// periodic, seed, samples) without metrics and pictures, keys sorted.
std::string computation(const Record& record);

/// Reads a results folder or a records file (.jsonl). Damaged lines are told, not fatal. Throws std::invalid_argument
/// when there is no such file, it holds no usable record, or one of another schema, saying how to go on.
ResultSet read_result_set(const std::filesystem::path& folder_or_file);

/// The finite number under record.metrics[metric][key], or nothing.
std::optional<double> metric_number(const Record& record, std::string_view metric, std::string_view key);

}  // namespace textonbench
