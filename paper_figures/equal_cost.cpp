#include "paper_figures/equal_cost.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>

namespace textonbench {
namespace {

constexpr std::array budgets{10.0, 30.0, 100.0, 300.0, 1e3, 3e3, 1e4, 3e4, 1e5};
constexpr double widest_ratio = 2;

std::pair<int, int> sample_size(const ReportRun& entry) {
  const Record& sample = entry.run.record->at("pictures").at("sample");
  return {sample.at("width").get<int>(), sample.at("height").get<int>()};
}

bool is_comparable(const ReportRun& entry) {
  return entry.run.ok() && entry.run.spec().gpu.empty() &&
         entry.run.record->value("pictures", Record::object()).contains("sample") &&
         value_of(entry, "operations_per_pixel").value_or(0) > 0 &&
         (value_of(entry, "rme") || value_of(entry, "smoothed_rme"));
}

double ratio_to(double budget, const CostedRun& run) { return std::abs(std::log(run.operations / budget)); }

CostLevel level_of(double budget, const std::vector<CostedRun>& runs) {
  CostLevel level{.budget = budget, .runs = {}, .absent = {}};
  std::vector<CostedRun> nearest;  // of each method
  for (const CostedRun& run : runs) {
    const std::string& method = run.entry->run.spec().method;
    const auto known = std::ranges::find(
        nearest, method, [](const CostedRun& other) -> const std::string& { return other.entry->run.spec().method; });
    if (known == nearest.end()) {
      nearest.push_back(run);
    } else if (ratio_to(budget, run) < ratio_to(budget, *known)) {
      *known = run;
    }
  }
  for (const CostedRun& run : nearest) {
    if (ratio_to(budget, run) <= std::log(widest_ratio)) {
      level.runs.push_back(run);
    } else {
      level.absent.push_back({run.entry->run.spec().method, run.operations});
    }
  }
  return level;
}

}  // namespace

std::optional<double> value_of(const ReportRun& run, const std::string& metric) {
  const Record metrics = run.run.record ? run.run.record->value("metrics", Record::object()) : Record::object();
  if (!metrics.contains(metric) || !metrics.at(metric).contains("value")) return std::nullopt;
  const Record& value = metrics.at(metric).at("value");
  return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
}

std::vector<CostedRun> costed_runs(const std::vector<ReportRun>& runs, const std::string& exemplar) {
  std::vector<CostedRun> costed;
  std::map<std::pair<int, int>, std::set<std::string>> methods;
  for (const ReportRun& entry : runs) {
    if (entry.run.spec().exemplar != exemplar || !is_comparable(entry)) continue;
    costed.push_back({&entry, *value_of(entry, "operations_per_pixel")});
    methods[sample_size(entry)].insert(entry.run.spec().method);
  }
  const auto usual = std::ranges::max_element(methods, {}, [](const auto& known) {
    const auto& [size, names] = known;
    return std::pair{names.size(), std::int64_t{size.first} * size.second};
  });
  std::erase_if(costed, [&](const CostedRun& run) { return sample_size(*run.entry) != usual->first; });
  return costed;
}

std::vector<CostLevel> cost_levels(const std::vector<CostedRun>& runs) {
  std::vector<CostLevel> levels;
  for (const double budget : budgets) {
    CostLevel level = level_of(budget, runs);
    if (level.runs.size() >= 2) levels.push_back(std::move(level));
  }
  return levels;
}

}  // namespace textonbench
