// The results that later ones are held against: a small folder, kept under version control.
//
//   records.jsonl   one record for each computation, without pictures, sorted by computation; what is kept of a record
//                   is schema, id, status, reason, spec, exemplar, metrics, and of its provenance what code and machine
//                   it comes from
//   history.jsonl   one line for each update: {schema, date, version, git_commit, git_dirty, reason, runs,
//                   exemplars, methods, metrics {NAME: mean over exemplars of the means over runs}}
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "experiments/result_set.h"

namespace textonbench {

struct BaselineUpdate {
  std::size_t runs = 0;
  std::size_t failed = 0;      ///< left out
  std::size_t other_code = 0;  ///< left out: this program would not reuse them
  nlohmann::ordered_json history_line;
};

/// Replaces the baseline in `folder` by the results and adds a line to its history, dated `date` (ISO 8601). Each file
/// is replaced as a whole, the records first. Throws std::invalid_argument for a reason that is blank and for a set
/// without a successful run of this version of the code, std::runtime_error when a file cannot be written.
BaselineUpdate update_baseline(const ResultSet& results, const std::filesystem::path& folder, const std::string& reason,
                               const std::string& date);

}  // namespace textonbench
