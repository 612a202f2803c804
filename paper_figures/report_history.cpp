#include "paper_figures/report_history.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "experiments/files.h"
#include "experiments/metrics/metric.h"
#include "paper_figures/metric_choice.h"
#include "paper_figures/number_format.h"
#include "paper_figures/templates.h"

namespace textonbench {
namespace {

using Json = nlohmann::ordered_json;

struct Baseline {
  Json line;
  std::string problem;  ///< why the line could not be used
};

std::vector<Baseline> read_history(const std::filesystem::path& file) {
  std::vector<Baseline> history;
  std::istringstream in(read_file(file));
  std::size_t number = 0;
  for (std::string text; std::getline(in, text);) {
    ++number;
    if (text.empty()) continue;
    Json line = Json::parse(text, nullptr, false);
    const bool usable = line.is_object() && line.contains("metrics") && line["metrics"].is_object();
    history.push_back({usable ? std::move(line) : Json::object(),
                       usable ? "" : fmt::format("{}:{} is not a line of history", file.filename().string(), number)});
  }
  return history;
}

std::optional<double> mean_of(const Json& line, std::string_view metric) {
  const auto metrics = line.find("metrics");
  if (metrics == line.end()) return std::nullopt;
  const auto found = metrics->find(std::string(metric));
  if (found == metrics->end() || !found->is_number()) return std::nullopt;
  return found->get<double>();
}

/// "+2.1 %" since the last baseline that has the metric; empty when nothing changed or there was none.
std::string change_since(std::optional<double> before, double now) {
  if (!before || *before == now || *before == 0) return "";
  const double percent = 100 * (now - *before) / std::abs(*before);
  return std::abs(percent) < 0.05 ? "" : fmt::format("{:+.1f} %", percent);
}

Json cells_of(const std::vector<Baseline>& history, std::size_t index, const std::vector<const MetricEntry*>& metrics) {
  Json cells = Json::array();
  for (const MetricEntry* metric : metrics) {
    const auto value = mean_of(history[index].line, metric->name);
    if (!value) {
      cells.push_back({{"value", "–"}, {"sort", nullptr}, {"change", nullptr}});
      continue;
    }
    std::optional<double> before;
    for (std::size_t k = index; k-- > 0 && !before;) before = mean_of(history[k].line, metric->name);
    cells.push_back({{"value", format_number(*value)},
                     {"sort", format_exact(*value)},
                     {"change", or_null(change_since(before, *value))}});
  }
  return cells;
}

std::string text_of(const Json& line, const char* key) {
  const auto found = line.find(key);
  return found != line.end() && found->is_string() ? found->get<std::string>() : "";
}

}  // namespace

std::string history_html(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return "";
  const std::vector<Baseline> history = read_history(file);
  if (history.empty()) return "";
  std::vector<const MetricEntry*> metrics;
  Json columns = Json::array();
  for (const MetricEntry& metric : metric_catalog()) {
    const auto has = [&](const Baseline& baseline) { return mean_of(baseline.line, metric.name).has_value(); };
    if (std::ranges::none_of(history, has)) continue;
    metrics.push_back(&metric);
    columns.push_back({{"title", metric.title}, {"unit", or_null(unit_of(metric))}});
  }
  Json rows = Json::array();
  for (std::size_t i = history.size(); i-- > 0;) {
    const Json& line = history[i].line;
    rows.push_back({{"problem", or_null(history[i].problem)},
                    {"date", text_of(line, "date")},
                    {"version", text_of(line, "version")},
                    {"commit", text_of(line, "git_commit").substr(0, 12)},
                    {"reason", text_of(line, "reason")},
                    {"runs", line.value("runs", 0)},
                    {"cells", cells_of(history, i, metrics)}});
  }
  return render_template("history", {{"columns", std::move(columns)}, {"rows", std::move(rows)}});
}

}  // namespace textonbench
