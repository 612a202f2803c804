// The records of other machines, joined to those here.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "experiments/record.h"

namespace textonbench {

struct MergeSummary {
  std::filesystem::path file;  ///< records.jsonl that was read
  std::size_t added = 0;
  std::size_t present = 0;           ///< records that are here already
  std::size_t pictures_copied = 0;   ///< and other pictures of the added records are here already, or …
  std::size_t pictures_missing = 0;  ///< … lie beside the records no more, or with other bytes than their name says
  std::vector<BadLine> bad_lines{};  ///< skipped
};

/// Appends the records of `source`, a records file or the results folder that holds it, that `results` lacks: a record
/// is the same by its id, status and time of finishing. Their pictures and source diffs are copied when they lie beside
/// the records; logs are not. Throws std::invalid_argument for a source that cannot be read, std::runtime_error when
/// something cannot be written; no record is added then.
MergeSummary merge_records(const std::filesystem::path& source, const ResultsFolder& results);

}  // namespace textonbench
