#include "experiments/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

#include "experiments/pairing.h"
#include "experiments/statistics/hypothesis_tests.h"

namespace textonbench {
namespace {

constexpr double interval_confidence = 0.95;
constexpr double false_alarm_rate = 0.05;
/// Replicates a test, so that the least p-value, 2 / (replicates + 1), stays significant after correction.
constexpr std::size_t replicates_per_test = 100;

double change_of(const NumberPair& pair, const MetricEntry& metric, const Margin& margin) {
  double before = pair.old_value, after = pair.new_value;
  if (metric.better == Better::nearer_zero) {
    before = std::fabs(before);
    after = std::fabs(after);
  }
  if (!margin.relative || before == after) return after - before;
  return (after - before) / std::max((std::fabs(before) + std::fabs(after)) / 2, margin.resolution);
}

/// One test on its way: a metric, over all methods or for one.
struct Cell {
  const MetricEntry* metric;
  Margin margin;
  Levels changes;
  std::size_t lost = 0;
  MetricComparison result;

  bool is_sampled() const { return !changes.empty() && margin.kind != Comparability::exact; }
};

Cell make_cell(const MetricEntry& metric, const std::vector<NumberPair>& numbers, const std::string& method) {
  Cell cell{.metric = &metric, .margin = margin_of(metric), .changes = {}, .lost = 0, .result = {}};
  MetricComparison& result = cell.result;
  result.metric = metric.name;
  result.method = method;
  result.margin = cell.margin.size;
  result.relative = cell.margin.relative;
  std::map<std::string, std::vector<double>> by_exemplar;
  for (const NumberPair& pair : numbers) {
    if (!method.empty() && pair.method != method) continue;
    by_exemplar[pair.exemplar].push_back(change_of(pair, metric, cell.margin));
    result.old_mean += pair.old_value;
    result.new_mean += pair.new_value;
    ++result.pairs;
  }
  result.old_mean /= static_cast<double>(std::max<std::size_t>(result.pairs, 1));
  result.new_mean /= static_cast<double>(std::max<std::size_t>(result.pairs, 1));
  result.exemplars = by_exemplar.size();
  std::vector<double> means;
  for (auto& [exemplar, changes] : by_exemplar) {
    double sum = 0;
    for (const double d : changes) sum += d;
    means.push_back(sum / static_cast<double>(changes.size()));
    if (sum > 0) ++result.larger;
    if (sum < 0) ++result.smaller;
    cell.changes.push_back(std::move(changes));
  }
  result.sign_rank_p_value = wilcoxon_signed_rank(means);
  return cell;
}

bool all_zero(const Levels& levels) {
  return std::all_of(levels.begin(), levels.end(), [](const std::vector<double>& numbers) {
    return std::all_of(numbers.begin(), numbers.end(), [](double x) { return x == 0; });
  });
}

void estimate(Cell& cell, int replicates, Seed seed) {
  MetricComparison& result = cell.result;
  // Identical numbers are the same, however few.
  if (all_zero(cell.changes)) return;
  const Seed own = derive(derive(seed, result.metric), result.method);
  const TestedMean tested = test_mean(cell.changes, interval_confidence, replicates, own);
  result.change = tested.estimate;
  result.p_value = tested.p_value;
  if (cell.margin.kind == Comparability::exact) {
    result.change.low = result.change.high = result.change.value;
    result.p_value = 0;
  }
}

/// The rule of compare.h.
Verdict judge(const Cell& cell) {
  const MetricComparison& result = cell.result;
  if (cell.lost > 0) return Verdict::worse;
  if (cell.changes.empty()) return Verdict::not_compared;
  const auto [value, low, high] = result.change;
  if ((-result.margin < low && high < result.margin) || all_zero(cell.changes)) return Verdict::same;
  if (result.p_value > false_alarm_rate) return Verdict::inconclusive;
  const double beyond = cell.margin.kind == Comparability::timed ? result.margin : 0;
  if (low <= beyond && high >= -beyond) return Verdict::inconclusive;
  if (cell.metric->better == Better::neither) return Verdict::changed;
  return (low > beyond) == (cell.metric->better == Better::higher) ? Verdict::better : Verdict::worse;
}

void correct_for_many(std::vector<Cell>& cells) {
  std::vector<double> p_values;
  for (const Cell& cell : cells) {
    if (cell.is_sampled()) p_values.push_back(cell.result.p_value);
  }
  const std::vector<double> corrected = holm(p_values);
  auto next = corrected.begin();
  for (Cell& cell : cells) {
    if (cell.is_sampled()) cell.result.p_value = *next++;
  }
}

/// The cells of a metric: all methods together, then each, where there are several.
std::vector<Cell> cells_of(const MetricEntry& metric, const MetricPairs& pairs) {
  std::vector<Cell> cells{make_cell(metric, pairs.numbers, "")};
  std::set<std::string> methods;
  for (const NumberPair& pair : pairs.numbers) methods.insert(pair.method);
  if (methods.size() > 1) {
    for (const std::string& method : methods) cells.push_back(make_cell(metric, pairs.numbers, method));
  }
  return cells;
}

/// Gathers judged cells into one row a metric.
std::vector<MetricComparison> rows_of(const std::vector<Cell>& cells) {
  std::vector<MetricComparison> rows;
  for (const Cell& cell : cells) {
    if (cell.result.method.empty()) {
      rows.push_back(cell.result);
    } else {
      rows.back().methods.push_back(cell.result);
    }
  }
  for (MetricComparison& row : rows) {
    for (const MetricComparison& method : row.methods) {
      if (method.verdict != Verdict::worse || row.verdict == Verdict::worse) continue;
      row.verdict = Verdict::worse;
      row.reason = fmt::format("worse for {}", method.method);
    }
  }
  return rows;
}

std::vector<std::string> newly_failed(const std::vector<RunPair>& pairs) {
  std::vector<std::string> failed;
  for (const RunPair& pair : pairs) {
    const std::string before = (*pair.old_run)["status"], after = (*pair.new_run)["status"];
    if (before != "ok" || after == "ok") continue;
    const Record& spec = (*pair.new_run)["spec"];
    failed.push_back(fmt::format("{} on {}, seed {}: {}: {}", pair.text("method"), pair.text("exemplar"),
                                 spec.contains("seed") ? spec["seed"].dump() : "?", after,
                                 pair.new_run->value("reason", "no reason given")));
  }
  return failed;
}

/// A bound as JSON, which knows no infinity.
Record finite_or_null(double x) { return std::isfinite(x) ? Record(x) : Record(nullptr); }

Record row_to_json(const MetricComparison& row) {
  Record json = {{"name", row.metric}};
  if (!row.method.empty()) json["method"] = row.method;
  json["verdict"] = to_string(row.verdict);
  if (!row.reason.empty()) json["reason"] = row.reason;
  const bool compared = row.pairs > 0;
  json["estimate"] = compared ? Record(row.change.value) : Record(nullptr);
  json["interval"] =
      compared ? Record{finite_or_null(row.change.low), finite_or_null(row.change.high)} : Record{nullptr, nullptr};
  json["margin"] = row.margin;
  json["relative"] = row.relative;
  json["old_mean"] = compared ? Record(row.old_mean) : Record(nullptr);
  json["new_mean"] = compared ? Record(row.new_mean) : Record(nullptr);
  json["p_value"] = row.p_value;
  json["sign_rank_p_value"] = row.sign_rank_p_value;
  json["pairs"] = row.pairs;
  json["exemplars"] = {{"all", row.exemplars}, {"larger", row.larger}, {"smaller", row.smaller}};
  if (!row.methods.empty()) {
    json["methods"] = Record::array();
    for (const MetricComparison& method : row.methods) json["methods"].push_back(row_to_json(method));
  }
  return json;
}

}  // namespace

std::string_view to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::better:
      return "better";
    case Verdict::same:
      return "same";
    case Verdict::worse:
      return "worse";
    case Verdict::inconclusive:
      return "inconclusive";
    case Verdict::changed:
      return "changed";
    case Verdict::not_compared:
      return "not compared";
  }
  return "";
}

std::size_t Comparison::regressions() const {
  const auto worse = std::count_if(metrics.begin(), metrics.end(),
                                   [](const MetricComparison& m) { return m.verdict == Verdict::worse; });
  return static_cast<std::size_t>(worse) + newly_failed.size();
}

Comparison compare(const ResultSet& old_set, const ResultSet& new_set, const CompareOptions& options) {
  const std::vector<RunPair> pairs = pair_runs(old_set, new_set);
  if (pairs.empty()) throw std::invalid_argument(explain_no_pairs(old_set, new_set));
  std::vector<Cell> cells;
  for (const MetricEntry& metric : metric_catalog()) {
    const MetricPairs found = collect_pairs(metric, pairs);
    std::vector<Cell> own = cells_of(metric, found);
    own.front().lost = found.lost;
    own.front().result.reason =
        found.lost > 0 ? fmt::format("{} value{} lost", found.lost, found.lost == 1 ? "" : "s") : found.reason;
    std::move(own.begin(), own.end(), std::back_inserter(cells));
  }
  const auto tests =
      static_cast<std::size_t>(std::count_if(cells.begin(), cells.end(), [](const Cell& c) { return c.is_sampled(); }));
  const int replicates = std::max(options.replicates, static_cast<int>(replicates_per_test * tests));
  for (Cell& cell : cells) {
    if (!cell.changes.empty()) estimate(cell, replicates, options.seed);
  }
  correct_for_many(cells);
  for (Cell& cell : cells) cell.result.verdict = judge(cell);

  return {.metrics = rows_of(cells),
          .pairs = pairs.size(),
          .only_old = old_set.runs.size() - pairs.size(),
          .only_new = new_set.runs.size() - pairs.size(),
          .newly_failed = newly_failed(pairs)};
}

std::string change_text(const MetricComparison& row, double change) {
  return row.relative ? fmt::format("{:+.2f} %", 100 * change) : fmt::format("{:+.3g}", change);
}

nlohmann::ordered_json to_json(const Comparison& comparison) {
  Record metrics = Record::array();
  for (const MetricComparison& row : comparison.metrics) metrics.push_back(row_to_json(row));
  return {
      {"metrics", metrics},
      {"regressions", comparison.regressions()},
      {"runs", {{"compared", comparison.pairs}, {"only_old", comparison.only_old}, {"only_new", comparison.only_new}}},
      {"newly_failed", comparison.newly_failed}};
}

}  // namespace textonbench
