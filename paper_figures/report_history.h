// How the committed baseline changed over time.
#pragma once

#include <filesystem>
#include <string>

namespace textonbench {

/// Section with a row for each line of results/baseline/history.jsonl, latest first: date, code, reason, and the mean
/// of each metric over exemplars with its change since the baseline before. Empty when the file is missing or empty.
/// A line that is not JSON is told in its place.
std::string history_html(const std::filesystem::path& file);

}  // namespace textonbench
