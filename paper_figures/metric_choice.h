// Metrics and names that tables and charts of a config ask for.
#pragma once

#include <string>
#include <vector>

#include "experiments/metrics/metric.h"
#include "paper_figures/figure_kind.h"
#include "paper_figures/groups.h"

namespace textonbench {

/// Entry of the metric catalogue. Throws ConfigError at `key` of the figure for an unknown name, or one that none of
/// the figure's runs measures.
const MetricEntry& require_metric(const FigureInput& input, const std::string& key, const std::string& name);

/// Every metric that a run of the figure measures, in catalogue order.
std::vector<const MetricEntry*> measured_metrics(const FigureInput& input);

/// "s", "dB", …; empty for a plain ratio.
std::string unit_of(const MetricEntry& metric);
/// "lower is better"; empty for a metric that only informs.
std::string direction_of(const MetricEntry& metric);

/// group_runs with the names that the figure's `labels = [{run = …, label = …}]` gives to its runs.
std::vector<RunGroup> labelled_groups(const FigureInput& input, const std::vector<std::string>& swept = {});
/// Throws ConfigError for a malformed `labels`.
void check_labels(const FigureTable& table);

}  // namespace textonbench
