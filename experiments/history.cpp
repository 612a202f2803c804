#include "experiments/history.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <initializer_list>

namespace textonbench {
namespace {

/// The text, number or object under nested keys of a record that another program may have written, or null.
const Record* find_in(const Record& record, std::initializer_list<const char*> path) {
  const Record* at = &record;
  for (const char* key : path) {
    if (!at->is_object()) return nullptr;
    const auto found = at->find(key);
    if (found == at->end()) return nullptr;
    at = &*found;
  }
  return at;
}

std::string text_in(const Record& record, std::initializer_list<const char*> path) {
  const Record* found = find_in(record, path);
  return found != nullptr && found->is_string() ? found->get<std::string>() : "unknown";
}

std::optional<double> number_in(const Record& record, std::initializer_list<const char*> path) {
  const Record* found = find_in(record, path);
  return found != nullptr && found->is_number() ? std::optional(found->get<double>()) : std::nullopt;
}

Extent size_of_exemplar(const Record& record) {
  return {static_cast<int>(number_in(record, {"exemplar", "width"}).value_or(0)),
          static_cast<int>(number_in(record, {"exemplar", "height"}).value_or(0))};
}

double work_of(Extent size, Extent exemplar_size, double samples) {
  return static_cast<double>((size.area() > 0 ? size : exemplar_size).area()) * samples;
}

/// Pixels of all samples of a record.
double work_of(const Record& record) {
  Extent size;
  if (const Record* sides = find_in(record, {"spec", "size"}); sides != nullptr && sides->size() == 2) {
    if ((*sides)[0].is_number() && (*sides)[1].is_number()) size = {(*sides)[0].get<int>(), (*sides)[1].get<int>()};
  }
  return work_of(size, size_of_exemplar(record), number_in(record, {"spec", "samples"}).value_or(0));
}

constexpr const char* current_code = "current";

/// What flatten takes for the code of a record: one word for the code of this program.
std::string code_of(const Record& record, const Record& spec) {
  std::string recorded = text_in(record, {"provenance", "code_version"});
  try {
    const auto metrics = spec.at("metrics").get<std::vector<std::string>>();
    return recorded == code_version(text_in(spec, {"method"}), metrics, spec.contains("gpu")) ? current_code : recorded;
  } catch (const std::exception&) {
    return recorded;  // a method or metric that is gone
  }
}

}  // namespace

History::FlatSpec History::flatten(const Record& spec, const std::string& code_version) {
  FlatSpec flat{{"code_version", code_version}};
  for (const auto& [key, value] : spec.items()) {
    if ((key == "params" || key == "gpu") && value.is_object()) {
      for (const auto& [name, option] : value.items()) flat[fmt::format("{}.{}", key, name)] = option.dump();
    } else {
      flat[key] = value.dump();
    }
  }
  return flat;
}

History::History(const std::vector<Record>& records) {
  std::map<std::string, std::vector<double>> rates;
  for (const Record& record : records) {
    const bool failed = record["status"] == "failed";
    Outcome& outcome = by_id_.try_emplace(record["id"].get<std::string>(), Outcome{true, ""}).first->second;
    if (outcome.failed) outcome = {failed, text_in(record, {"reason"})};
    const Record* spec = find_in(record, {"spec"});
    if (spec == nullptr || !spec->is_object()) continue;
    const std::string method = text_in(*spec, {"method"});
    specs_[{method, text_in(*spec, {"exemplar"})}].push_back(flatten(*spec, code_of(record, *spec)));
    if (const Extent size = size_of_exemplar(record); size.area() > 0) {
      exemplar_sizes_[text_in(*spec, {"exemplar_sha256"})] = size;
    }
    const std::optional<double> seconds = number_in(record, {"time", "wall_seconds"});
    if (const double work = work_of(record); record["status"] == "ok" && seconds && work > 0) {
      rates[method].push_back(*seconds / work);
    }
  }
  for (auto& [method, values] : rates) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    seconds_per_pixel_[method] = *middle;
  }
}

bool History::is_reusable(const std::string& id) const {
  const auto found = by_id_.find(id);
  return found != by_id_.end() && !found->second.failed;
}

std::string History::why_run(const PlannedRun& run) const {
  if (const auto earlier = by_id_.find(run.id); earlier != by_id_.end() && earlier->second.failed) {
    return "an earlier run failed: " + earlier->second.reason;
  }
  const auto group = specs_.find({run.spec.method, run.spec.exemplar});
  if (group == specs_.end()) {
    return fmt::format("never run: no record of {} on {}", run.spec.method, run.spec.exemplar);
  }
  const FlatSpec wanted = flatten(to_json(run.spec), current_code);
  // Parameters of a method may come and go with its code, so either side may lack a key.
  const auto differences = [&](const FlatSpec& old) {
    std::map<std::string, std::string> found;
    const auto value = [](const FlatSpec& spec, const std::string& key) {
      const auto at = spec.find(key);
      return at == spec.end() ? "none" : at->second;
    };
    for (const FlatSpec* side : {&old, &wanted}) {
      for (const auto& [key, ignored] : *side) {
        const std::string before = value(old, key), after = value(wanted, key);
        if (before != after) found[key] = fmt::format("{} ({} -> {})", key, before, after);
      }
    }
    return found;
  };
  std::map<std::string, std::string> nearest = differences(group->second.back());
  for (const FlatSpec& old : group->second) {
    if (auto found = differences(old); found.size() < nearest.size()) nearest = std::move(found);
  }
  const bool other_code = nearest.contains("code_version") && nearest.size() == 1;
  std::vector<std::string> parts;
  parts.reserve(nearest.size());
  for (const auto& [key, text] : nearest) parts.push_back(text);
  return fmt::format(
      "{}{}",
      other_code ? "recorded under another code version: " : "never run: differs from the nearest recorded run in ",
      fmt::join(parts, ", "));
}

std::optional<double> History::estimate_seconds(const RunSpec& spec, Extent exemplar_size) const {
  const auto rate = seconds_per_pixel_.find(spec.method);
  if (rate == seconds_per_pixel_.end()) return std::nullopt;
  return rate->second * work_of(spec.size, exemplar_size, spec.samples);
}

std::optional<Extent> History::exemplar_size(const std::string& sha256) const {
  const auto found = exemplar_sizes_.find(sha256);
  return found == exemplar_sizes_.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace textonbench
