#include "experiments/pairing.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

namespace textonbench {
namespace {

constexpr std::size_t fewest_repetitions = 9;

bool ok(const Record& record) { return record["status"] == "ok"; }

std::set<std::string> values_of(const ResultSet& set, const char* key) {
  std::set<std::string> values;
  for (const auto& [computation, record] : set.runs) {
    const auto found = record["spec"].find(key);
    if (found != record["spec"].end()) values.insert(found->is_string() ? found->get<std::string>() : found->dump());
  }
  return values;
}

std::string listed(const std::set<std::string>& values) {
  constexpr std::size_t most = 4;
  const std::vector<std::string> first(
      values.begin(), std::next(values.begin(), static_cast<std::ptrdiff_t>(std::min(most, values.size()))));
  return fmt::format("{}{}", fmt::join(first, ", "),
                     values.size() > most ? fmt::format(" and {} more", values.size() - most) : "");
}

/// Why times of these two runs cannot be compared, or nothing.
std::string machine_difference(const RunPair& pair) {
  const auto part = [](const Record& record, const char* key) {
    const Record provenance = record.value("provenance", Record::object());
    return provenance.contains(key) ? provenance[key].dump() : std::string("unknown");
  };
  for (const char* key : {"cpu", "cores", "threads"}) {
    const std::string before = part(*pair.old_run, key), after = part(*pair.new_run, key);
    if (before == "unknown" || before == "\"unknown\"") return fmt::format("the {} of the runs is not known", key);
    if (before != after) return fmt::format("other machine: {} {} and {}", key, before, after);
  }
  return {};
}

/// Method with its parameters on an exemplar: what is timed again by each seed.
std::string timed_thing(const RunPair& pair) {
  const Record& spec = (*pair.old_run)["spec"];
  std::string thing;
  for (const char* key : {"exemplar", "method", "params", "size", "periodic"}) {
    if (const auto part = spec.find(key); part != spec.end()) thing += part->dump() + " ";
  }
  return thing;
}

std::size_t repetitions(const MetricEntry& metric, const RunPair& pair) {
  if (metric.name == "analyze_seconds") return 1;
  return (*pair.old_run)["spec"].value("samples", std::size_t{1});
}

/// Keeps the runs whose times may be compared; says why none is left.
std::vector<RunPair> comparable_times(const MetricEntry& metric, const std::vector<RunPair>& runs,
                                      std::string* reason) {
  std::vector<RunPair> same_machine;
  for (const RunPair& run : runs) {
    const std::string difference = machine_difference(run);
    if (difference.empty()) {
      same_machine.push_back(run);
    } else if (reason->empty()) {
      *reason = difference;
    }
  }
  if (same_machine.empty()) return {};
  std::map<std::string, std::size_t> counts;
  for (const RunPair& run : same_machine) counts[timed_thing(run)] += repetitions(metric, run);
  std::size_t most = 0;
  for (const auto& [thing, count] : counts) most = std::max(most, count);
  std::erase_if(same_machine, [&](const RunPair& run) { return counts[timed_thing(run)] < fewest_repetitions; });
  *reason = same_machine.empty()
                ? fmt::format("{} repetition{}: expected at least {}", most, most == 1 ? "" : "s", fewest_repetitions)
                : "";
  return same_machine;
}

bool asked_for(const Record& record, std::string_view metric) {
  const auto metrics = record["spec"].find("metrics");
  return metrics != record["spec"].end() && std::find(metrics->begin(), metrics->end(), metric) != metrics->end();
}

}  // namespace

std::vector<RunPair> pair_runs(const ResultSet& old_set, const ResultSet& new_set) {
  std::vector<RunPair> pairs;
  for (const auto& [computation, old_run] : old_set.runs) {
    const auto found = new_set.runs.find(computation);
    if (found != new_set.runs.end()) pairs.push_back({&old_run, &found->second});
  }
  return pairs;
}

std::string explain_no_pairs(const ResultSet& old_set, const ResultSet& new_set) {
  std::vector<std::string> differences;
  for (const char* key : {"method", "params", "exemplar", "exemplar_sha256", "size", "periodic", "seed", "samples"}) {
    const std::set<std::string> before = values_of(old_set, key), after = values_of(new_set, key);
    const bool shared =
        std::any_of(before.begin(), before.end(), [&](const std::string& value) { return after.contains(value); });
    if (!shared) differences.push_back(fmt::format("{}: {} | {}", key, listed(before), listed(after)));
  }
  return fmt::format(
      "{} and {} share no run. {}", old_set.file.string(), new_set.file.string(),
      differences.empty()
          ? "Each part of a run (method, params, exemplar, size, seed, …) has values in both; they never "
            "come together in one run"
          : fmt::format("No value in common (old | new): {}", fmt::join(differences, "; ")));
}

MetricPairs collect_pairs(const MetricEntry& metric, const std::vector<RunPair>& runs) {
  MetricPairs result;
  std::vector<RunPair> measured;
  for (const RunPair& run : runs) {
    if (!ok(*run.old_run) || !ok(*run.new_run) || !metric_number(*run.old_run, metric.name, "value")) continue;
    if (metric_number(*run.new_run, metric.name, "value")) {
      measured.push_back(run);
    } else if (asked_for(*run.new_run, metric.name)) {
      ++result.lost;
    }
  }
  if (measured.empty()) {
    result.reason = "no pair of runs has it";
    return result;
  }
  const bool timed = margin_of(metric).kind == Comparability::timed;
  if (timed) measured = comparable_times(metric, measured, &result.reason);
  for (const RunPair& run : measured) {
    NumberPair numbers{run.text("exemplar"), run.text("method"), *metric_number(*run.old_run, metric.name, "value"),
                       *metric_number(*run.new_run, metric.name, "value")};
    const std::optional<double> old_floor = metric_number(*run.old_run, metric.name, "floor");
    const std::optional<double> new_floor = metric_number(*run.new_run, metric.name, "floor");
    if (timed && old_floor && new_floor && *old_floor > 0 && *new_floor > 0) {
      numbers.old_value /= *old_floor;
      numbers.new_value /= *new_floor;
    }
    result.numbers.push_back(std::move(numbers));
  }
  return result;
}

}  // namespace textonbench
