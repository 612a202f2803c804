#include "paper_figures/report_changes.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "experiments/compare.h"
#include "paper_figures/number_format.h"
#include "paper_figures/templates.h"

namespace textonbench {
namespace {

nlohmann::ordered_json change_row(const MetricComparison& row) {
  std::string verdict_class(to_string(row.verdict));
  std::ranges::replace(verdict_class, ' ', '-');
  const bool compared = row.pairs > 0;
  return {
      {"name", row.method.empty() ? row.metric : row.metric + ", " + row.method},
      {"verdict", to_string(row.verdict)},
      {"class", verdict_class},
      {"old", compared ? format_number(row.old_mean) : "–"},
      {"new", compared ? format_number(row.new_mean) : "–"},
      {"change", compared ? change_text(row, row.change.value) : "–"},
      {"sort", compared ? nlohmann::ordered_json(format_exact(row.change.value)) : nullptr},
      {"interval",
       compared ? fmt::format("{} … {}", change_text(row, row.change.low), change_text(row, row.change.high)) : "–"},
      {"exemplars", row.exemplars},
      {"reason", or_null(row.reason)}};
}

nlohmann::ordered_json comparison_view(const Comparison& comparison) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const MetricComparison& row : comparison.metrics) {
    if (row.pairs == 0 && row.reason == "no pair of runs has it") continue;
    rows.push_back(change_row(row));
    for (const MetricComparison& method : row.methods) {
      if (method.verdict != row.verdict || row.verdict == Verdict::worse) rows.push_back(change_row(method));
    }
  }
  return {{"problem", nullptr},
          {"summary", fmt::format("{} runs compared, {} only in the baseline, {} new; {} worse.", comparison.pairs,
                                  comparison.only_old, comparison.only_new, comparison.regressions())},
          {"has_rows", !rows.empty()},
          {"rows", std::move(rows)},
          {"has_failures", !comparison.newly_failed.empty()},
          {"failures", comparison.newly_failed}};
}

}  // namespace

std::string changes_html(const ResultsFolder& results) {
  const std::filesystem::path baseline = results.path() / "baseline";
  if (!std::filesystem::exists(baseline / "records.jsonl")) return "";
  try {
    return render_template("changes",
                           comparison_view(compare(read_result_set(baseline), read_result_set(results.path()))));
  } catch (const std::invalid_argument& error) {
    return render_template("changes", {{"problem", error.what()}, {"has_rows", false}, {"has_failures", false}});
  }
}

}  // namespace textonbench
