#include "paper_figures/report_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "experiments/metrics/metric.h"
#include "paper_figures/anchors.h"
#include "paper_figures/groups.h"
#include "paper_figures/metric_choice.h"
#include "paper_figures/number_format.h"
#include "paper_figures/templates.h"

namespace textonbench {
namespace {

using Json = nlohmann::ordered_json;

Json run_fact(const std::string& title, const std::string& value, const std::string& link = "") {
  return {{"title", title}, {"value", value}, {"link", or_null(link)}};
}

std::string params_text(const RunSpec& spec) {
  std::vector<std::string> parts;
  for (const auto& [name, value] : options_of(spec)) {
    if (const std::string told = to_string(value); !told.empty()) parts.push_back(fmt::format("{} = {}", name, told));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string size_text(const RunSpec& spec, const Record& exemplar) {
  if (spec.size.area() > 0) return format_size(spec.size.width, spec.size.height);
  if (!exemplar.is_object()) return "as the exemplar";
  return format_size(exemplar.value("width", 0), exemplar.value("height", 0)) + ", as the exemplar";
}

double number_or_zero(const Record& object, const char* key) {
  return object.contains(key) && object[key].is_number() ? object[key].get<double>() : 0;
}

Json facts_of_result(const Record& record) {
  Json facts = Json::array();
  const Record time = record.value("time", Record::object());
  if (const double seconds = number_or_zero(time, "wall_seconds"); seconds > 0) {
    facts.push_back(run_fact("Time", format_number(seconds) + " s"));
  }
  if (const double bytes = number_or_zero(time, "peak_bytes"); bytes > 0) {
    facts.push_back(run_fact("Peak memory", format_bytes(bytes)));
  }
  const Record provenance = record.value("provenance", Record::object());
  const bool is_dirty = provenance.value("git_dirty", Record()) == Record(true);
  facts.push_back(run_fact("Commit", provenance.value("git_commit", std::string("unknown")) +
                                         (is_dirty ? ", with uncommitted changes" : "")));
  facts.push_back(run_fact("Code version", provenance.value("code_version", std::string("unknown"))));
  return facts;
}

Json facts_of(const ReportRun& entry) {
  const RunSpec& spec = entry.run.spec();
  const Record exemplar = entry.run.record ? entry.run.record->value("exemplar", Record()) : Record();
  Json facts = Json::array();
  facts.push_back(run_fact("Config", entry.config->title, fmt::format("#{}", config_anchor(*entry.config))));
  facts.push_back(run_fact("Method", spec.method));
  if (!options_of(spec).empty()) facts.push_back(run_fact("Options", params_text(spec)));
  facts.push_back(run_fact("Exemplar", spec.exemplar, fmt::format("#{}", exemplar_anchor(spec.exemplar))));
  facts.push_back(run_fact("Size", size_text(spec, exemplar) + (spec.periodic ? ", periodic" : ", not periodic")));
  facts.push_back(run_fact("Seed", std::to_string(spec.seed)));
  facts.push_back(run_fact("Samples", std::to_string(spec.samples)));
  if (!entry.run.record) return facts;
  for (Json& more : facts_of_result(*entry.run.record)) facts.push_back(std::move(more));
  return facts;
}

Json metrics_of(const SelectedRun& run) {
  Json metrics = Json::array();
  for (const MetricEntry& metric : metric_catalog()) {
    const Average number = metric_of(run, metric.name);
    if (!number.value) continue;
    const FormattedValue text = format_value(*number.value, number.error);
    metrics.push_back({{"title", metric.title},
                       {"value", text.value},
                       {"error", or_null(text.error)},
                       {"floor", number.floor ? format_number(*number.floor) : ""},
                       {"unit", unit_of(metric)}});
  }
  return metrics;
}

Json pictures_of(const SelectedRun& run, const PictureStore& store) {
  Json pictures = Json::array();
  if (!run.record) return pictures;
  const Record kept = run.record->value("pictures", Record::object());
  for (const auto& [name, picture] : kept.items()) {
    const std::string file = picture.value("file", std::string());
    const auto key = store.key_of(file);
    pictures.push_back({{"name", name}, {"file", file}, {"shown", key ? Json(*key) : Json(nullptr)}});
  }
  return pictures;
}

Json record_view(const ReportRun& entry, const PictureStore& store) {
  const SelectedRun& run = entry.run;
  Json metrics = metrics_of(run);
  Json pictures = pictures_of(run, store);
  const std::string command = run.record ? run.record->value("command", std::string()) : command_line(run.spec());
  return {{"id", run.planned->id},
          {"status", run.status()},
          {"title", entry.title()},
          {"reason", or_null(run.reason())},
          {"facts", facts_of(entry)},
          {"command", command.empty() ? command_line(run.spec()) : command},
          {"has_metrics", !metrics.empty()},
          {"metrics", std::move(metrics)},
          {"has_pictures", !pictures.empty()},
          {"pictures", std::move(pictures)},
          {"json", run.record ? Json(run.record->dump(2)) : Json(nullptr)}};
}

Json missing_exemplars(const std::vector<ReportConfig>& configs) {
  Json missing = Json::array();
  for (const ReportConfig& config : configs) {
    for (const MissingExemplar& exemplar : config.plan.missing) {
      missing.push_back({{"name", exemplar.name},
                         {"runs", exemplar.runs},
                         {"config", config.config.title},
                         {"how", exemplar.how_to_get}});
    }
  }
  return missing;
}

}  // namespace

std::string ReportRun::title() const {
  return fmt::format("{} on {}, seed {}", run.label, run.spec().exemplar, run.spec().seed);
}

std::vector<ReportRun> report_runs(const std::vector<ReportConfig>& configs, const std::vector<Record>& records) {
  std::vector<ReportRun> runs;
  std::vector<std::string> ids;
  std::set<std::string> known;
  for (const ReportConfig& config : configs) {
    for (const PlannedRun& planned : config.plan.runs) {
      if (!known.insert(planned.id).second) continue;
      runs.push_back({{&planned, planned.label, std::nullopt}, &config.config});
      ids.push_back(planned.id);
    }
  }
  std::vector<std::optional<Record>> found = latest_by_id(records, ids);
  for (std::size_t i = 0; i < runs.size(); ++i) runs[i].run.record = std::move(found[i]);
  return runs;
}

RunCounts count_runs(const std::vector<ReportRun>& runs) {
  RunCounts counts;
  counts.planned = runs.size();
  for (const ReportRun& entry : runs) {
    const std::string status = entry.run.status();
    ++(status == "ok"        ? counts.recorded
       : status == "refused" ? counts.refused
       : status == "missing" ? counts.missing
                             : counts.failed);
  }
  return counts;
}

std::string in_words(const RunCounts& counts) {
  if (counts.planned == 0) return "no runs";
  std::string text =
      fmt::format("{} run{}, {} recorded", counts.planned, counts.planned == 1 ? "" : "s", counts.recorded);
  if (counts.failed > 0) text += fmt::format(", {} failed", counts.failed);
  if (counts.refused > 0) text += fmt::format(", {} refused", counts.refused);
  if (counts.missing > 0) text += fmt::format(", {} not run yet", counts.missing);
  return text;
}

std::string records_html(const std::vector<ReportRun>& runs, const PictureStore& pictures) {
  Json records = Json::array();
  for (const ReportRun& entry : runs) records.push_back(record_view(entry, pictures));
  return render_template("records", {{"count", runs.size()}, {"records", std::move(records)}});
}

std::string problems_html(const std::vector<ReportRun>& runs, const std::vector<ReportConfig>& configs,
                          const std::vector<BadLine>& bad_lines) {
  Json unsuccessful = Json::array();
  for (const ReportRun& entry : runs) {
    if (entry.run.ok()) continue;
    const std::string status = entry.run.status();
    const std::string reason = entry.run.record ? entry.run.record->value("reason", std::string("no reason recorded"))
                                                : "textonbench run " + config_argument(*entry.config) + " makes it";
    unsuccessful.push_back(
        {{"status", status}, {"id", entry.run.planned->id}, {"title", entry.title()}, {"reason", reason}});
  }
  Json missing = missing_exemplars(configs);
  Json lines = Json::array();
  for (const BadLine& line : bad_lines) lines.push_back({{"line", line.line}, {"reason", line.reason}});
  return render_template("problems", {{"any", !unsuccessful.empty() || !missing.empty() || !lines.empty()},
                                      {"has_runs", !unsuccessful.empty()},
                                      {"runs", std::move(unsuccessful)},
                                      {"has_missing", !missing.empty()},
                                      {"missing", std::move(missing)},
                                      {"has_bad_lines", !lines.empty()},
                                      {"bad_lines", std::move(lines)}});
}

}  // namespace textonbench
