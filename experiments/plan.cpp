#include "experiments/plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "experiments/gpu_run.h"
#include "experiments/metrics/metric.h"
#include "experiments/pictures.h"
#include "experiments/sweep.h"

namespace textonbench {
namespace {

/// Finds exemplars, hashing the file of each once for a whole plan.
class ExemplarChooser {
 public:
  explicit ExemplarChooser(const ExemplarCatalog& catalog) : catalog_(catalog) {}

  /// Names and tags into exemplars. Of a grid, each once; a zip keeps what is written.
  std::vector<const ChosenExemplar*> choose(const RunsTable& table) {
    std::vector<const ChosenExemplar*> chosen;
    for (std::size_t i = 0; i < table.exemplars.size(); ++i) {
      at_place(table, fmt::format("exemplars[{}]", i), [&] {
        for (const std::string& name : expand_tag(table.exemplars[i])) {
          const ChosenExemplar* exemplar = look_up(name);
          if (table.combine == Combine::zip || std::ranges::find(chosen, exemplar) == chosen.end()) {
            chosen.push_back(exemplar);
          }
        }
      });
    }
    return chosen;
  }

 private:
  std::vector<std::string> expand_tag(const std::string& name) const {
    if (!name.starts_with('@')) {
      return {name};
    }
    std::vector<std::string> names = catalog_.tagged(std::string_view(name).substr(1));
    if (names.empty()) {
      std::set<std::string> tags;
      for (const ExemplarInfo& info : catalog_.all()) {
        std::ranges::transform(info.tags, std::inserter(tags, tags.end()), [](const auto& tag) { return "@" + tag; });
      }
      throw std::invalid_argument(fmt::format(
          "no exemplar has the tag \"{}\"{}; tags are {}", name,
          did_you_mean(name, std::vector<std::string_view>(tags.begin(), tags.end())), fmt::join(tags, ", ")));
    }
    return names;
  }

  const ChosenExemplar* look_up(const std::string& name) {
    if (const auto known = chosen_.find(name); known != chosen_.end()) {
      return &known->second;
    }
    const ExemplarInfo& info = catalog_.look_up(name);
    // A wrong file under a known name is an error; an exemplar that is merely not here is told.
    const bool absent = !info.available && info.file.empty();
    return &chosen_.emplace(name, ChosenExemplar{&info, absent ? std::string() : exemplar_sha256(info)}).first->second;
  }

  const ExemplarCatalog& catalog_;
  std::unordered_map<std::string, ChosenExemplar> chosen_;  // its elements never move
};

/// Sorted names, each once; "@all", "@model", "@sample" and "@cost" stand for metrics of that level,
/// "@identity" for those that test theory, which the others leave out, as they do those of frames.
std::vector<std::string> choose_metrics(const RunsTable& table) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < table.metrics.size(); ++i) {
    const std::string& name = table.metrics[i];
    at_place(table, fmt::format("metrics[{}]", i), [&] {
      if (!name.starts_with('@')) {
        names.insert(std::string(find_metric(name).name));
        return;
      }
      constexpr std::pair<std::string_view, MetricLevel> levels[] = {
          {"@model", MetricLevel::model}, {"@sample", MetricLevel::sample}, {"@cost", MetricLevel::cost}};
      const auto level = std::ranges::find(levels, name, &std::pair<std::string_view, MetricLevel>::first);
      if (level == std::end(levels) && name != "@all" && name != "@identity") {
        throw std::invalid_argument(
            fmt::format("unknown group of metrics \"{}\"; expected @all, @model, @sample, @cost or @identity", name));
      }
      for (const MetricEntry& entry : metric_catalog()) {
        const bool in_group = name == "@identity" || name == "@all" || entry.level == level->second;
        if (entry.level == MetricLevel::frame) continue;
        if (in_group && entry.identity == (name == "@identity")) {
          names.insert(std::string(entry.name));
        }
      }
    });
  }
  for (const std::string& name : names) {
    if (table.step != 1 && find_metric(name).level == MetricLevel::sample) {
      throw ConfigError(
          place_of(table, "step"),
          fmt::format("step = {}: {} compares pixels of samples with those of the exemplar, a pixel apart; "
                      "expected step = 1 or metrics of the levels model and cost",
                      table.step, name));
    }
  }
  return {names.begin(), names.end()};
}

void check_gpu(const RunsTable& table, const std::vector<std::string>& metrics) {
  for (const bool periodic : table.periodic) {
    const std::optional<GpuObjection> objection = object_to_gpu(metrics, !table.gpu.empty(), periodic);
    if (objection) throw ConfigError(place_of(table, objection->key), objection->message);
  }
}

std::vector<std::string> choose_pictures(const RunsTable& table) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < table.pictures.size(); ++i) {
    at_place(table, fmt::format("pictures[{}]", i),
             [&] { names.insert(std::string(find_picture(table.pictures[i]).name)); });
  }
  return {names.begin(), names.end()};
}

std::vector<const MethodEntry*> choose_methods(const RunsTable& table) {
  std::vector<const MethodEntry*> methods;
  for (std::size_t i = 0; i < table.methods.size(); ++i) {
    methods.push_back(at_place(table, fmt::format("method[{}]", i), [&] { return &find_method(table.methods[i]); }));
  }
  return methods;
}

void note_missing(Plan& plan, const ExemplarInfo& info) {
  const auto known = std::ranges::find(plan.missing, info.name, &MissingExemplar::name);
  if (known == plan.missing.end()) {
    plan.missing.push_back({info.name, info.how_to_get, 1});
  } else {
    ++known->runs;
  }
}

}  // namespace

Plan make_plan(const Config& config, const ExemplarCatalog& exemplars, std::size_t most_runs) {
  ExemplarChooser chooser(exemplars);
  Plan plan;
  std::unordered_map<std::string, std::size_t> index_of;
  for (const RunsTable& table : config.runs) {
    const std::vector<std::string> metrics = choose_metrics(table);
    check_gpu(table, metrics);
    const Sweep sweep(table,
                      {.methods = choose_methods(table),
                       .exemplars = chooser.choose(table),
                       .metrics = metrics,
                       .pictures = choose_pictures(table)},
                      exemplars);
    if (const std::size_t count = sweep.count(); count > most_runs) {
      throw ConfigError(table.place,
                        fmt::format("[[runs]] \"{}\" is a sweep of {} runs, more than {}: give --yes-large to have it",
                                    table.label, count, most_runs));
    }
    std::set<std::size_t> indices;
    sweep.expand([&](RunSpec spec, const ChosenExemplar& exemplar) {
      if (!exemplar.info->available) {
        note_missing(plan, *exemplar.info);
        return;
      }
      std::string id = run_id(spec);
      const auto [known, is_new] = index_of.emplace(id, plan.runs.size());
      if (is_new) {
        plan.runs.push_back({std::move(spec), std::move(id), table.label});
      }
      indices.insert(known->second);
    });
    plan.by_label[table.label].assign(indices.begin(), indices.end());
  }
  return plan;
}

}  // namespace textonbench
