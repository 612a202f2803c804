#include "paper_figures/report_context.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include "paper_figures/anchors.h"
#include "paper_figures/number_format.h"
#include "paper_figures/templates.h"

namespace textonbench {
namespace {

using Json = nlohmann::ordered_json;

/// What is known of one exemplar from the runs on it.
struct SeenExemplar {
  std::string name, sha256;
  std::string size;
  Record picture;
};

std::vector<SeenExemplar> seen_exemplars(const std::vector<ReportRun>& runs) {
  std::vector<SeenExemplar> seen;
  for (const ReportRun& entry : runs) {
    const RunSpec& spec = entry.run.spec();
    auto known = std::ranges::find(seen, spec.exemplar, &SeenExemplar::name);
    if (known == seen.end()) known = seen.insert(seen.end(), {spec.exemplar, spec.exemplar_sha256, "", Record()});
    if (!entry.run.record) continue;
    const Record& record = *entry.run.record;
    const Record shape = record.value("exemplar", Record());
    if (shape.is_object()) {
      const int channels = shape.value("channels", 0);
      known->size = fmt::format("{}, {}", format_size(shape.value("width", 0), shape.value("height", 0)),
                                channels == 1 ? "gray" : "color");
    }
    const Record pictures = record.value("pictures", Record::object());
    if (pictures.contains("exemplar")) known->picture = pictures["exemplar"];
  }
  return seen;
}

Json fact(const std::string& title, const std::string& value, bool code = false) {
  return {{"title", title}, {"value", value}, {"code", code}};
}

std::string in_words(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (!value.is_object()) return value.dump();
  std::vector<std::string> parts;
  for (const auto& [key, part] : value.items()) parts.push_back(key + " " + in_words(part));
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string key_title(std::string key) {
  static const std::map<std::string, std::string> acronyms{{"cpu", "CPU"}, {"os", "OS"}, {"fft_plans", "FFT plans"}};
  if (const auto acronym = acronyms.find(key); acronym != acronyms.end()) return acronym->second;
  std::ranges::replace(key, '_', ' ');
  if (!key.empty() && key[0] >= 'a' && key[0] <= 'z') key[0] = static_cast<char>(key[0] - 'a' + 'A');
  return key;
}

/// The numbers that a benchmark itself adds to Google Benchmark's own.
bool is_counter(const std::string& key, const Json& value) {
  static const std::set<std::string> own{"family_index", "per_family_instance_index",
                                         "repetitions",  "repetition_index",
                                         "threads",      "iterations",
                                         "real_time",    "cpu_time"};
  return value.is_number() && !own.contains(key);
}

bool is_median(const Json& row) { return row.value("aggregate_name", std::string()) == "median"; }

/// Medians where a benchmark was repeated, single rows otherwise.
std::vector<Json> best_rows(const Json& benchmarks) {
  std::set<std::string> repeated;
  for (const Json& row : benchmarks) {
    if (is_median(row)) repeated.insert(row.value("run_name", std::string()));
  }
  std::vector<Json> rows;
  for (const Json& row : benchmarks) {
    const bool single = row.value("run_type", std::string("iteration")) == "iteration" &&
                        !repeated.contains(row.value("run_name", std::string()));
    if (single || is_median(row)) rows.push_back(row);
  }
  return rows;
}

Json number_cell(const Json& row, const std::string& key, const std::string& unit) {
  if (!row.contains(key) || !row[key].is_number()) return {{"value", "–"}, {"sort", nullptr}};
  const auto value = row[key].get<double>();
  return {{"value", format_number(value) + unit}, {"sort", format_exact(value)}};
}

/// The name without what Google Benchmark adds on how it timed: "synthesis/rpn/256/iterations:60/manual_time".
std::string benchmark_name(const Json& row) {
  std::istringstream parts(row.value("run_name", row.value("name", std::string())));
  std::string name;
  for (std::string part; std::getline(parts, part, '/');) {
    if (part.find(':') != std::string::npos || part.ends_with("_time")) continue;
    name += (name.empty() ? "" : "/") + part;
  }
  return name;
}

std::string machine_of(const Json& context) {
  std::string text = fmt::format("{} processors", context.value("num_cpus", 0));
  if (const int mhz = context.value("mhz_per_cpu", 0); mhz > 0) text += fmt::format(" at {} MHz", mhz);
  if (context.value("cpu_scaling_enabled", false)) text += ", frequency scaling on (timings vary)";
  if (context.contains("caches")) {
    for (const Json& cache : context["caches"]) {
      text += fmt::format(", L{} {} {}", cache.value("level", 0), cache.value("type", std::string("cache")),
                          format_bytes(cache.value("size", 0.0)));
    }
  }
  return text;
}

Json speed_view(const Json& document) {
  const std::vector<Json> rows = best_rows(document.at("benchmarks"));
  std::vector<std::string> counters;
  for (const Json& row : rows) {
    for (const auto& [key, value] : row.items()) {
      if (is_counter(key, value) && std::ranges::find(counters, key) == counters.end()) counters.push_back(key);
    }
  }
  Json columns{"Time", "Processor time"};
  for (const std::string& counter : counters) columns.push_back(key_title(counter));
  Json views = Json::array();
  for (const Json& row : rows) {
    const std::string unit = " " + row.value("time_unit", std::string("ns"));
    Json cells{number_cell(row, "real_time", unit), number_cell(row, "cpu_time", unit)};
    for (const std::string& counter : counters) cells.push_back(number_cell(row, counter, ""));
    views.push_back({{"name", benchmark_name(row)},
                     {"error", row.value("error_occurred", false) ? row["error_message"] : Json(nullptr)},
                     {"cells", std::move(cells)}});
  }
  return {{"problem", nullptr},
          {"context", machine_of(document.value("context", Json::object()))},
          {"has_rows", !views.empty()},
          {"columns", std::move(columns)},
          {"rows", std::move(views)}};
}

}  // namespace

std::string exemplars_html(const std::vector<ReportRun>& runs, const ExemplarCatalog& exemplars, PictureStore& pictures,
                           const std::map<std::string, std::string>& pages) {
  Json views = Json::array();
  for (const SeenExemplar& seen : seen_exemplars(runs)) {
    const auto info = std::ranges::find(exemplars.all(), seen.name, &ExemplarInfo::name);
    Json facts = Json::array();
    if (!seen.size.empty()) facts.push_back(fact("Size", seen.size));
    if (info != exemplars.all().end()) {
      facts.push_back(fact("Source", info->source));
      facts.push_back(fact("License", info->licence.empty() ? "not stated" : info->licence));
    }
    facts.push_back(fact("SHA-256", seen.sha256, true));
    const auto key = seen.picture.is_object() ? pictures.show(seen.picture, PictureFit::window) : std::nullopt;
    views.push_back({{"anchor", exemplar_anchor(seen.name)},
                     {"name", seen.name},
                     {"page", pages.contains(seen.name) ? Json(pages.at(seen.name)) : Json(nullptr)},
                     {"picture", key ? Json(*key) : Json(nullptr)},
                     {"facts", std::move(facts)}});
  }
  return render_template("exemplars", {{"exemplars", std::move(views)}});
}

std::string environment_html(const std::vector<ReportRun>& runs) {
  std::vector<std::pair<Record, std::size_t>> variants;
  for (const ReportRun& entry : runs) {
    if (!entry.run.record) continue;
    Record provenance = entry.run.record->value("provenance", Record::object());
    provenance.erase("code_version");  // of the method and metrics of a run, not of where it ran
    const auto known = std::ranges::find(variants, provenance, &std::pair<Record, std::size_t>::first);
    if (known == variants.end())
      variants.emplace_back(provenance, 1);
    else
      ++known->second;
  }
  Json views = Json::array();
  for (const auto& [provenance, count] : variants) {
    Json facts = Json::array();
    for (const auto& [key, value] : provenance.items()) facts.push_back(fact(key_title(key), in_words(value)));
    views.push_back({{"title", fmt::format("{} record{}", count, count == 1 ? "" : "s")}, {"facts", std::move(facts)}});
  }
  return render_template("environment", {{"variants", std::move(views)}});
}

std::string speed_html(const std::string& json) {
  if (json.empty()) return "";
  try {
    return render_template("speed", speed_view(Json::parse(json)));
  } catch (const Json::exception& error) {
    return render_template(
        "speed", {{"problem", std::string("benchmarks.json is not what Google Benchmark writes: ") + error.what()},
                  {"context", nullptr},
                  {"has_rows", false}});
  }
}

}  // namespace textonbench
