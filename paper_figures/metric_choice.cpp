#include "paper_figures/metric_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace textonbench {
namespace {

bool is_measured(const FigureInput& input, std::string_view name) {
  return std::ranges::any_of(input.runs, [&](const SelectedRun& run) {
    return std::ranges::find(run.spec().metrics, name) != run.spec().metrics.end();
  });
}

}  // namespace

const MetricEntry& require_metric(const FigureInput& input, const std::string& key, const std::string& name) {
  const MetricEntry* metric = nullptr;
  try {
    metric = &find_metric(name);
  } catch (const std::invalid_argument& error) {
    throw ConfigError(place_of(input.table, key), error.what());
  }
  if (!input.runs.empty() && !is_measured(input, name)) {
    throw ConfigError(
        place_of(input.table, key),
        fmt::format("no run of figure \"{}\" measures \"{}\": add it to their metrics", input.table.name, name));
  }
  return *metric;
}

std::vector<const MetricEntry*> measured_metrics(const FigureInput& input) {
  std::vector<const MetricEntry*> metrics;
  for (const MetricEntry& metric : metric_catalog()) {
    if (is_measured(input, metric.name)) metrics.push_back(&metric);
  }
  return metrics;
}

std::string unit_of(const MetricEntry& metric) { return metric.unit == "1" ? "" : std::string(metric.unit); }

std::string direction_of(const MetricEntry& metric) {
  switch (metric.better) {
    case Better::lower:
      return "lower is better";
    case Better::higher:
      return "higher is better";
    case Better::nearer_zero:
      return "nearer zero is better";
    case Better::neither:
      break;
  }
  return "";
}

std::vector<RunGroup> labelled_groups(const FigureInput& input, const std::vector<std::string>& swept) {
  std::vector<RunGroup> groups = group_runs(input.runs, swept);
  const auto labels = input.table.lists.find("labels");
  if (labels == input.table.lists.end()) return groups;
  for (RunGroup& group : groups) {
    const std::string& run = group.runs.front()->label;
    for (const auto& entry : labels->second) {
      if (to_string(entry.at("run")) == run)
        group.title = to_string(entry.at("label")) + group.title.substr(run.size());
    }
  }
  return groups;
}

void check_labels(const FigureTable& table) {
  constexpr std::array<std::string_view, 2> keys{"run", "label"};
  require_known_columns(table, "labels", keys, {});
}

}  // namespace textonbench
