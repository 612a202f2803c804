#include "paper_figures/selection.h"

#include <fmt/format.h>

#include <algorithm>

namespace textonbench {
namespace {

constexpr std::size_t most_named = 5;

std::string first_few(const std::vector<std::string>& names) {
  const std::size_t shown = std::min(names.size(), most_named);
  std::string text =
      fmt::format("{}", fmt::join(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(shown), "; "));
  if (shown < names.size()) text += fmt::format("; and {} more", names.size() - shown);
  return text;
}

}  // namespace

std::string SelectedRun::status() const { return record ? record->value("status", std::string("failed")) : "missing"; }

std::string SelectedRun::reason() const {
  if (!record) return "not run yet";
  if (ok()) return "";
  return fmt::format("{}: {}", status(), record->value("reason", std::string("no reason recorded")));
}

std::vector<SelectedRun> select_runs(const FigureTable& figure, const Plan& plan, const std::vector<Record>& records) {
  std::vector<SelectedRun> selected;
  for (const std::string& label : figure.runs) {
    const auto table = plan.by_label.find(label);
    if (table == plan.by_label.end()) continue;
    for (const std::size_t i : table->second) selected.push_back({&plan.runs[i], label, std::nullopt});
  }

  std::vector<std::string> ids;
  ids.reserve(selected.size());
  for (const SelectedRun& run : selected) ids.push_back(run.planned->id);
  std::vector<std::optional<Record>> found = latest_by_id(records, ids);
  for (std::size_t i = 0; i < selected.size(); ++i) selected[i].record = std::move(found[i]);
  return selected;
}

std::optional<std::string> unusable(const Config& config, const std::vector<SelectedRun>& runs) {
  const std::string command = fmt::format("textonbench run {}", config_argument(config));
  if (runs.empty()) {
    return "it has no runs: none of its exemplars is available here (textonbench list exemplars says how to get them)";
  }
  std::vector<std::string> missing;
  for (const SelectedRun& run : runs) {
    if (!run.record) missing.push_back(describe(run));
  }
  if (!missing.empty()) {
    return fmt::format("{} of its {} records {} missing: {}. To make them: {}", missing.size(), runs.size(),
                       missing.size() == 1 ? "is" : "are", first_few(missing), command);
  }
  return std::nullopt;
}

std::string describe(const SelectedRun& run) {
  return fmt::format("{} on {}, seed {} (id {})", run.label, run.spec().exemplar, run.spec().seed, run.planned->id);
}

std::vector<std::string> exemplars_of(const std::vector<SelectedRun>& runs) {
  std::vector<std::string> names;
  for (const SelectedRun& run : runs) {
    if (std::find(names.begin(), names.end(), run.spec().exemplar) == names.end()) names.push_back(run.spec().exemplar);
  }
  return names;
}

std::string config_argument(const Config& config) {
  const std::string in_tree = "configs/" + config.name + ".toml";
  const std::string file = config.file.generic_string();
  return file.ends_with("/" + in_tree) ? in_tree : file;
}

std::optional<std::string> attribute_of(const RunSpec& spec, const std::string& key) {
  if (key == "exemplar") return spec.exemplar;
  if (key == "seed") return std::to_string(spec.seed);
  if (key == "method") return spec.method;
  if (key == "periodic") return spec.periodic ? "true" : "false";
  if (key == "width") return std::to_string(spec.size.width);
  if (key == "height") return std::to_string(spec.size.height);
  const std::map<std::string, ParamValue> options = options_of(spec);
  const auto option = options.find(key);
  return option == options.end() ? std::nullopt : std::optional(to_string(option->second));
}

}  // namespace textonbench
