#include "experiments/result_set.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <stdexcept>

namespace textonbench {
namespace {

std::filesystem::path records_file(const std::filesystem::path& given) {
  if (!std::filesystem::exists(given)) {
    throw std::invalid_argument(
        fmt::format("{}: no such file or folder: expected a results folder or a records file", given.string()));
  }
  if (!std::filesystem::is_directory(given)) return given;
  std::filesystem::path file = given / "records.jsonl";
  if (!std::filesystem::exists(file)) {
    throw std::invalid_argument(fmt::format(
        "{}: no records.jsonl in it: expected a results folder, as \"textonbench run\" writes it", given.string()));
  }
  return file;
}

void require_known_schema(const Record& json, const std::filesystem::path& file, std::size_t line) {
  if (!json.contains("schema") || json["schema"] == record_schema) return;
  const Record writer = json.value("provenance", Record::object());
  throw std::invalid_argument(fmt::format(
      "{}:{}: a record of schema {}, written by textonbench {}; this one reads schema {}. Compare with the program "
      "that wrote it, or make the records again: \"textonbench run\" for a results folder, and then \"textonbench "
      "baseline "
      "update --reason TEXT\" for a baseline",
      file.string(), line, json["schema"].dump(), writer.value("version", "of an unknown version"), record_schema));
}

/// Why a line cannot be compared, or nothing.
std::optional<std::string> result_defect(const Record& json) {
  if (std::optional<std::string> defect = record_defect(json)) return defect;
  for (const char* key : {"spec", "metrics"}) {
    if (!json.contains(key) || !json[key].is_object()) return fmt::format("no object under \"{}\"", key);
  }
  for (const char* key : {"method", "exemplar"}) {
    const Record& spec = json["spec"];
    if (!spec.contains(key) || !spec[key].is_string()) return fmt::format("no text under \"spec.{}\"", key);
  }
  return std::nullopt;
}

}  // namespace

std::string computation(const Record& record) {
  nlohmann::json spec = record["spec"];
  spec.erase("metrics");
  spec.erase("pictures");
  return spec.dump();
}

ResultSet read_result_set(const std::filesystem::path& folder_or_file) {
  ResultSet set;
  set.file = records_file(folder_or_file);
  std::ifstream in(set.file, std::ios::binary);
  std::size_t number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    Record json = Record::parse(line, nullptr, /*allow_exceptions=*/false);
    if (json.is_object()) require_known_schema(json, set.file, number);
    if (std::optional<std::string> defect = result_defect(json)) {
      set.bad_lines.push_back({number, *std::move(defect)});
      continue;
    }
    Record& kept = set.runs[computation(json)];
    if (kept.is_null() || stands_for(json, kept)) kept = std::move(json);
  }
  if (in.bad() || !in.eof()) throw std::invalid_argument(fmt::format("{}: cannot be read", set.file.string()));
  if (set.runs.empty()) throw std::invalid_argument(fmt::format("{}: no usable record in it", set.file.string()));
  return set;
}

std::optional<double> metric_number(const Record& record, std::string_view metric, std::string_view key) {
  const Record& metrics = record["metrics"];
  const auto entry = metrics.find(metric);
  if (entry == metrics.end() || !entry->is_object()) return std::nullopt;
  const auto number = entry->find(key);
  if (number == entry->end() || !number->is_number()) return std::nullopt;
  const auto value = number->get<double>();
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

}  // namespace textonbench
