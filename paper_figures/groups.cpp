#include "paper_figures/groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "paper_figures/number_format.h"

namespace textonbench {
namespace {

using Attributes = std::map<std::string, std::string>;

/// Everything of a run but its exemplar and seed, in words.
Attributes attributes_of(const PlannedRun& run) {
  Attributes attributes;
  for (const auto& [name, value] : options_of(run.spec)) attributes[name] = to_string(value);
  const Extent size = run.spec.size;
  attributes["size"] = size.area() > 0 ? format_size(size.width, size.height) : "as exemplar";
  attributes["periodic"] = run.spec.periodic ? "yes" : "no";
  attributes["method"] = run.spec.method;
  attributes["samples"] = std::to_string(run.spec.samples);
  return attributes;
}

struct Key {
  std::string label;
  Attributes attributes;
  friend bool operator==(const Key&, const Key&) = default;
};

std::set<std::string> varying_attributes(const std::vector<Key>& keys, const std::string& label) {
  std::set<std::string> varying;
  const Attributes* first = nullptr;
  for (const Key& key : keys) {
    if (key.label != label) continue;
    if (first == nullptr) first = &key.attributes;
    for (const auto& [name, value] : key.attributes) {
      const auto other = first->find(name);
      if (other == first->end() || other->second != value) varying.insert(name);
    }
    for (const auto& [name, value] : *first) {
      if (!key.attributes.contains(name)) varying.insert(name);
    }
  }
  return varying;
}

std::string title_of(const Key& key, const std::set<std::string>& varying) {
  std::vector<std::string> parts;
  for (const std::string& name : varying) {
    const auto value = key.attributes.find(name);
    if (value != key.attributes.end()) parts.push_back(name + " = " + value->second);
  }
  return parts.empty() ? key.label : fmt::format("{} ({})", key.label, fmt::join(parts, ", "));
}

std::string detail_of(const PlannedRun& run) {
  std::string text = run.spec.method;
  for (const auto& [name, value] : options_of(run.spec)) {
    if (const std::string told = to_string(value); !told.empty()) text += fmt::format(", {} = {}", name, told);
  }
  if (run.spec.size.area() > 0) text += ", " + format_size(run.spec.size.width, run.spec.size.height);
  if (!run.spec.periodic) text += ", not periodic";
  return text + fmt::format(", {} sample{}", run.spec.samples, run.spec.samples == 1 ? "" : "s");
}

/// Running mean of independent numbers, their errors and their floors.
class Mean {
 public:
  void add(const Average& number) {
    if (!number.value) return;
    values_.push_back(*number.value);
    if (number.error) squared_errors_ += *number.error * *number.error;
    if (number.floor) floors_ += *number.floor;
    has_errors_ = has_errors_ && number.error.has_value();
    has_floors_ = has_floors_ && number.floor.has_value();
  }
  Average result() const {
    if (values_.empty()) return {};
    const auto n = static_cast<double>(values_.size());
    double sum = 0;
    for (const double value : values_) sum += value;
    Average average{.value = sum / n, .count = values_.size()};
    if (has_errors_) average.error = std::sqrt(squared_errors_) / n;
    if (has_floors_) average.floor = floors_ / n;
    if (values_.size() > 1) {
      double squares = 0;
      for (const double value : values_) squares += (value - *average.value) * (value - *average.value);
      average.spread = std::sqrt(squares / (n - 1));
    }
    return average;
  }

 private:
  std::vector<double> values_;
  double squared_errors_ = 0, floors_ = 0;
  bool has_errors_ = true, has_floors_ = true;
};

std::optional<double> finite_number(const Record& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number()) return std::nullopt;
  const double value = found->get<double>();
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

}  // namespace

std::vector<const SelectedRun*> RunGroup::on(std::string_view exemplar) const {
  std::vector<const SelectedRun*> chosen;
  for (const SelectedRun* run : runs) {
    if (run->spec().exemplar == exemplar) chosen.push_back(run);
  }
  return chosen;
}

std::vector<RunGroup> group_runs(const std::vector<SelectedRun>& runs, const std::vector<std::string>& swept) {
  std::vector<Key> keys;
  std::vector<RunGroup> groups;
  for (const SelectedRun& run : runs) {
    Key key{run.label, attributes_of(*run.planned)};
    for (const std::string& name : swept) key.attributes.erase(name);
    const auto known = std::find(keys.begin(), keys.end(), key);
    const auto index = static_cast<std::size_t>(known - keys.begin());
    if (known == keys.end()) {
      keys.push_back(std::move(key));
      groups.push_back({"", detail_of(*run.planned), {}});
    }
    groups[index].runs.push_back(&run);
  }
  for (std::size_t i = 0; i < groups.size(); ++i) {
    groups[i].title = title_of(keys[i], varying_attributes(keys, keys[i].label));
  }
  return groups;
}

Average metric_of(const SelectedRun& run, std::string_view metric) {
  if (!run.ok()) return {};
  const Record metrics = run.record->value("metrics", Record::object());
  const auto found = metrics.find(std::string(metric));
  if (found == metrics.end()) return {};
  Average number{.value = finite_number(*found, "value")};
  if (!number.value) return {};
  number.error = finite_number(*found, "stderr");
  number.floor = finite_number(*found, "floor");
  number.count = 1;
  return number;
}

Average average_over_seeds(const std::vector<const SelectedRun*>& runs, std::string_view metric) {
  Mean mean;
  for (const SelectedRun* run : runs) mean.add(metric_of(*run, metric));
  Average average = mean.result();
  average.spread.reset();
  return average;
}

Average average_over_exemplars(const RunGroup& group, std::string_view metric) {
  std::vector<std::string_view> exemplars;
  Mean mean;
  for (const SelectedRun* run : group.runs) {
    const std::string_view exemplar = run->spec().exemplar;
    if (std::find(exemplars.begin(), exemplars.end(), exemplar) != exemplars.end()) continue;
    exemplars.push_back(exemplar);
    mean.add(average_over_seeds(group.on(exemplar), metric));
  }
  return mean.result();
}

}  // namespace textonbench
