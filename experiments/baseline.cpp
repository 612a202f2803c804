#include "experiments/baseline.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>
#include <vector>

#include "experiments/files.h"
#include "experiments/metrics/metric.h"
#include "experiments/run_spec.h"

namespace textonbench {
namespace {

Record part_of(const Record& json, std::initializer_list<const char*> keys) {
  Record part = Record::object();
  for (const char* key : keys) {
    if (const auto found = json.find(key); found != json.end()) part[key] = *found;
  }
  return part;
}

Record provenance_of(const Record& record) { return record.value("provenance", Record::object()); }

Record reduced(const Record& record) {
  Record kept = part_of(record, {"schema", "id", "status", "reason", "spec", "exemplar", "metrics"});
  kept["spec"]["pictures"] = Record::array();
  kept["provenance"] = part_of(provenance_of(record), {"version", "code_version", "git_commit", "git_dirty", "compiler",
                                                       "build_type", "cpu", "cores", "threads"});
  return kept;
}

/// Whether this program would compute the same, so that it would reuse the record.
bool is_current(const Record& record) {
  try {
    const RunSpec spec = run_spec_from_json(record["spec"]);
    return provenance_of(record).value("code_version", "unknown") == code_version(spec);
  } catch (const std::invalid_argument&) {
    return false;  // a method or metric that is gone
  }
}

std::string finished(const Record& record) {
  return record.value("time", Record::object()).value("finished", std::string());
}

const Record& latest_of(const std::vector<const Record*>& records) {
  return **std::max_element(records.begin(), records.end(),
                            [](const Record* a, const Record* b) { return finished(*a) < finished(*b); });
}

Record means_of(const std::vector<const Record*>& records) {
  Record means = Record::object();
  for (const MetricEntry& metric : metric_catalog()) {
    struct Sum {
      double total = 0;
      int count = 0;
    };
    std::map<std::string, Sum> by_exemplar;
    for (const Record* record : records) {
      const std::optional<double> value = metric_number(*record, metric.name, "value");
      if (!value) continue;
      Sum& sum = by_exemplar[(*record)["spec"]["exemplar"]];
      sum.total += *value;
      ++sum.count;
    }
    double total = 0;
    for (const auto& [exemplar, sum] : by_exemplar) total += sum.total / sum.count;
    if (!by_exemplar.empty()) means[std::string(metric.name)] = total / static_cast<double>(by_exemplar.size());
  }
  return means;
}

std::size_t distinct(const std::vector<const Record*>& records, const char* spec_key) {
  std::set<std::string> values;
  for (const Record* record : records) values.insert((*record)["spec"][spec_key].get<std::string>());
  return values.size();
}

}  // namespace

BaselineUpdate update_baseline(const ResultSet& results, const std::filesystem::path& folder, const std::string& reason,
                               const std::string& date) {
  if (reason.find_first_not_of(" \t\r\n") == std::string::npos) {
    throw std::invalid_argument("a baseline is not changed without a reason: expected some words on why");
  }
  BaselineUpdate update;
  std::vector<const Record*> records;
  for (const auto& [computation, record] : results.runs) {
    if (record["status"] == "failed") {
      ++update.failed;
    } else {
      records.push_back(&record);
    }
  }
  update.other_code = std::erase_if(records, [](const Record* r) { return !is_current(*r); });
  update.runs = records.size();
  if (std::none_of(records.begin(), records.end(), [](const Record* r) { return (*r)["status"] == "ok"; })) {
    throw std::invalid_argument(
        fmt::format("{}: no successful run of this version of the program in it: a baseline cannot be empty; "
                    "textonbench run makes the runs again",
                    results.file.string()));
  }
  const Record& latest = latest_of(records);

  std::string lines;
  for (const Record* record : records) lines += reduced(*record).dump() + "\n";
  Record& line = update.history_line = {{"schema", record_schema}, {"date", date}};
  line.update(part_of(provenance_of(latest), {"version", "git_commit", "git_dirty"}));
  line["reason"] = reason;
  line["runs"] = records.size();
  line["exemplars"] = distinct(records, "exemplar");
  line["methods"] = distinct(records, "method");
  line["metrics"] = means_of(records);

  const std::filesystem::path history_file = folder / "history.jsonl";
  const std::string history =
      (std::filesystem::exists(history_file) ? read_file(history_file) : std::string()) + line.dump() + "\n";
  std::filesystem::create_directories(folder);
  write_atomically(folder / "records.jsonl", lines);
  write_atomically(history_file, history);
  return update;
}

}  // namespace textonbench
