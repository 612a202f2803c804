#include "experiments/claims.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>
#include <stdexcept>
#include <unordered_map>
#include <utility>

#include "experiments/metrics/metric.h"
#include "methods/method.h"

namespace textonbench {
namespace {

constexpr double confidence = 0.95;
constexpr int claim_replicates = 10'000;

using RecordsById = std::unordered_map<std::string, const Record*>;
/// Value of each exemplar and seed.
using PairedValues = std::map<std::pair<std::string, std::uint64_t>, double>;

/// Why a claim has no verdict.
class CannotJudge : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

std::optional<ParamValue> trait_of(const RunSpec& spec, const std::string& key) {
  if (key == "exemplar") return spec.exemplar;
  if (key == "seed") return static_cast<std::int64_t>(spec.seed);
  const std::map<std::string, ParamValue> options = options_of(spec);
  const auto option = options.find(key);
  return option == options.end() ? std::nullopt : std::optional(option->second);
}

bool meets_conditions(const RunSpec& spec, const ClaimSelection& selection) {
  return std::ranges::all_of(
      selection.conditions, [&](const auto& condition) { return trait_of(spec, condition.first) == condition.second; });
}

/// Runs of the selection, in plan order.
std::vector<const PlannedRun*> chosen_runs(const Plan& plan, const ClaimSelection& selection) {
  std::vector<const PlannedRun*> chosen;
  for (const std::size_t i : plan.by_label.at(selection.run)) {
    if (meets_conditions(plan.runs[i].spec, selection)) chosen.push_back(&plan.runs[i]);
  }
  return chosen;
}

void check_selection(const ClaimSelection& selection, const Plan& plan) {
  const auto label = plan.by_label.find(selection.run);
  if (label == plan.by_label.end()) {
    std::vector<std::string_view> known;
    for (const auto& [name, indices] : plan.by_label) known.emplace_back(name);
    throw ConfigError(selection.places.at("run"),
                      fmt::format("no [[runs]] table of the config is named \"{}\"{}; it has {}", selection.run,
                                  did_you_mean(selection.run, known), fmt::join(known, ", ")));
  }
  // A table whose exemplars are all elsewhere leaves nothing to check against.
  if (label->second.empty()) return;
  for (const auto& condition : selection.conditions) {
    const std::string& key = condition.first;
    const bool known =
        std::ranges::any_of(label->second, [&](std::size_t i) { return trait_of(plan.runs[i].spec, key).has_value(); });
    if (!known) {
      throw ConfigError(
          selection.places.at(key),
          fmt::format("unknown selector \"{}\": expected run, metric, part, over_seeds, exemplar, seed or a "
                      "parameter of the method",
                      key));
    }
  }
  for (const std::size_t i : label->second) {
    const std::vector<std::string>& measured = plan.runs[i].spec.metrics;
    if (std::ranges::find(measured, selection.metric) == measured.end()) {
      throw ConfigError(selection.places.at("metric"),
                        fmt::format("the runs \"{}\" do not measure \"{}\"", selection.run, selection.metric));
    }
  }
  if (plan.missing.empty() && chosen_runs(plan, selection).empty()) {
    throw ConfigError(selection.place, fmt::format("no run of \"{}\" meets these conditions", selection.run));
  }
}

/// The first need that is not there, in words.
std::optional<std::string> unmet_need(const Claim& claim) {
  const auto listed = [](const auto& catalog, std::string_view name) {
    return std::ranges::any_of(catalog, [&](const auto& entry) { return entry.name == name; });
  };
  for (const std::string& need : claim.needs) {
    const std::string_view text = need;
    const std::string_view name = text.substr(text.find(':') + 1);
    if (text.starts_with("method:") && !listed(method_catalog(), name)) {
      return fmt::format("method not yet built: {}", name);
    }
    if (text.starts_with("metric:") && !listed(metric_catalog(), name)) {
      return fmt::format("metric not yet built: {}", name);
    }
  }
  if (std::ranges::find(claim.needs, "gpu") != claim.needs.end()) return "needs a GPU";
  return std::nullopt;
}

double number_of(const Record& record, const ClaimSelection& selection) {
  const std::string id = record.value("id", "");
  const Record metrics = record.value("metrics", Record::object());
  const auto metric = metrics.find(selection.metric);
  if (metric == metrics.end()) {
    throw CannotJudge(fmt::format("record {} has no {}", id, selection.metric));
  }
  const Record number = metric->value(selection.floor ? "floor" : "value", Record());
  if (!number.is_number() || !std::isfinite(number.get<double>())) {
    throw CannotJudge(
        fmt::format("record {} has no finite {}{}", id, selection.metric, selection.floor ? " floor" : ""));
  }
  return number.get<double>();
}

/// One number an exemplar, as of seed 0.
PairedValues take_over_seeds(const PairedValues& values, OverSeeds over_seeds) {
  if (over_seeds == OverSeeds::each) return values;
  std::map<std::string, std::vector<double>> by_exemplar;
  for (const auto& [key, value] : values) by_exemplar[key.first].push_back(value);
  PairedValues result;
  for (const auto& [exemplar, numbers] : by_exemplar) {
    const auto count = static_cast<double>(numbers.size());
    const double mean = std::accumulate(numbers.begin(), numbers.end(), 0.0) / count;
    double& number = result[{exemplar, 0}];
    if (over_seeds == OverSeeds::mean) {
      number = mean;
    } else if (over_seeds == OverSeeds::least) {
      number = std::ranges::min(numbers);
    } else {
      if (numbers.size() < 2) throw CannotJudge(fmt::format("a single seed on {} has no deviation", exemplar));
      double squares = 0;
      for (const double value : numbers) squares += (value - mean) * (value - mean);
      number = std::sqrt(squares / (count - 1));
    }
  }
  return result;
}

PairedValues values_of(const ClaimSelection& selection, const Plan& plan, const RecordsById& records,
                       std::vector<std::string>& ids) {
  const std::vector<const PlannedRun*> runs = chosen_runs(plan, selection);
  if (runs.empty()) {
    std::vector<std::string_view> names;
    for (const MissingExemplar& missing : plan.missing) names.emplace_back(missing.name);
    throw CannotJudge(fmt::format("exemplar not here: {}", fmt::join(names, ", ")));
  }
  std::size_t absent = 0, unsuccessful = 0;
  std::set<std::string> refusals;
  std::map<std::pair<std::string, std::uint64_t>, std::vector<double>> values;
  for (const PlannedRun* run : runs) {
    const auto known = records.find(run->id);
    if (known == records.end()) {
      ++absent;
    } else if (known->second->value("status", "") != "ok") {
      ++unsuccessful;
      if (known->second->value("status", "") == "refused") refusals.insert(known->second->value("reason", ""));
    } else {
      values[{run->spec.exemplar, run->spec.seed}].push_back(number_of(*known->second, selection));
      if (std::ranges::find(ids, run->id) == ids.end()) ids.push_back(run->id);
    }
  }
  if (absent > 0) {
    throw CannotJudge(fmt::format("no record yet of {} of the {} runs \"{}\"", absent, runs.size(), selection.run));
  }
  if (unsuccessful > 0) {
    if (refusals.size() == 1) throw CannotJudge(*refusals.begin());
    throw CannotJudge(
        fmt::format("{} of the {} runs \"{}\" failed or were refused", unsuccessful, runs.size(), selection.run));
  }
  PairedValues means;
  for (const auto& [key, repeated] : values) {
    double sum = 0;
    for (const double value : repeated) sum += value;
    means[key] = sum / static_cast<double>(repeated.size());
  }
  return take_over_seeds(means, selection.over_seeds);
}

/// measure − against, or the logarithm of their ratio, where both have a value.
PairedValues combine_pairs(const PairedValues& measured, const PairedValues& against, CombinePair combine) {
  PairedValues pairs;
  for (const auto& [key, value] : measured) {
    const auto other = against.find(key);
    if (other == against.end()) continue;
    if (combine == CombinePair::difference) {
      pairs[key] = value - other->second;
      continue;
    }
    if (value <= 0 || other->second <= 0) {
      throw CannotJudge(
          fmt::format("{} and {} on {} have no ratio: expected positive numbers", value, other->second, key.first));
    }
    pairs[key] = std::log(value / other->second);
  }
  if (pairs.empty()) throw CannotJudge("no exemplar and seed have both runs");
  return pairs;
}

Levels levels_of(const PairedValues& values) {
  Levels levels;
  const std::string* exemplar = nullptr;
  for (const auto& [key, value] : values) {
    if (exemplar == nullptr || *exemplar != key.first) levels.emplace_back();
    exemplar = &key.first;
    levels.back().push_back(value);
  }
  return levels;
}

ClaimVerdict judge(const Estimate& measured, const ExpectedRange& expected, bool has_caveat) {
  if (measured.low > expected.high || measured.high < expected.low) return ClaimVerdict::deviates;
  if (measured.low < expected.low || measured.high > expected.high) return ClaimVerdict::inconclusive;
  return has_caveat ? ClaimVerdict::reproduced_with_caveat : ClaimVerdict::reproduced;
}

Estimate estimate(const Claim& claim, const Plan& plan, const RecordsById& records, std::vector<std::string>& ids) {
  const ClaimTest& test = *claim.test;
  PairedValues values = values_of(test.measure, plan, records, ids);
  if (test.against) {
    values = combine_pairs(values, values_of(*test.against, plan, records, ids), test.combine);
  }
  const Seed seed = derive(derive(Seed{1}, "claims"), claim.id);
  Estimate result = bootstrap_mean(levels_of(values), confidence, claim_replicates, seed);
  if (test.against && test.combine == CombinePair::ratio) {
    for (double* part : {&result.value, &result.low, &result.high}) *part = std::exp(*part);
  }
  return result;
}

void evaluate_test(const Plan& plan, const RecordsById& records, ClaimOutcome& outcome) {
  const Claim& claim = *outcome.claim;
  outcome.command = "textonbench run " + claim.test->config;
  try {
    outcome.measured = estimate(claim, plan, records, outcome.records);
  } catch (const CannotJudge& obstacle) {
    outcome.reason = fmt::format("{}: {}", obstacle.what(), outcome.command);
    return;
  }
  outcome.verdict = judge(*outcome.measured, claim.test->expect, !claim.caveat.empty());
  std::set<std::string> left_out;
  for (const MissingExemplar& missing : plan.missing) left_out.insert(missing.name);
  if (!left_out.empty()) outcome.reason = fmt::format("without {}: not here", fmt::join(left_out, ", "));
}

constexpr std::array<std::string_view, 5> verdict_names{"reproduced", "reproduced with a caveat", "inconclusive",
                                                        "deviates", "not run"};

}  // namespace

std::string_view verdict_name(ClaimVerdict verdict) { return verdict_names.at(static_cast<std::size_t>(verdict)); }

ClaimVerdict verdict_of(std::string_view name) {
  const auto known = std::ranges::find(verdict_names, name);
  if (known == verdict_names.end()) {
    throw std::invalid_argument(fmt::format("unknown verdict \"{}\"{}; expected one of: {}", name,
                                            did_you_mean(name, verdict_names), fmt::join(verdict_names, ", ")));
  }
  return static_cast<ClaimVerdict>(known - verdict_names.begin());
}

void check_claims(std::span<const Claim> claims, const ClaimPlans& plans) {
  for (const Claim& claim : claims) {
    if (!claim.test) continue;
    const auto plan = plans.find(claim.test->config);
    if (plan == plans.end()) {
      throw ConfigError(claim.test->config_place,
                        fmt::format("no config is named \"{}\" (textonbench list configs)", claim.test->config));
    }
    check_selection(claim.test->measure, plan->second);
    if (claim.test->against) check_selection(*claim.test->against, plan->second);
  }
}

std::vector<ClaimOutcome> evaluate_claims(std::span<const Claim> claims, const ClaimPlans& plans,
                                          const std::vector<Record>& records) {
  RecordsById latest;
  for (const Record& record : records) {
    const Record*& kept = latest[record.value("id", "")];
    if (kept == nullptr || stands_for(record, *kept)) kept = &record;
  }
  std::vector<ClaimOutcome> outcomes;
  outcomes.reserve(claims.size());
  for (const Claim& claim : claims) {
    ClaimOutcome& outcome = outcomes.emplace_back();
    outcome.claim = &claim;
    if (const std::optional<std::string> need = unmet_need(claim)) {
      outcome.reason = *need;
    } else if (!claim.test) {
      outcome.reason = "what it needs is there, but its test is not written yet";
    } else {
      evaluate_test(plans.at(claim.test->config), latest, outcome);
    }
  }
  return outcomes;
}

}  // namespace textonbench
