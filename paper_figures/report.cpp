#include "paper_figures/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "experiments/files.h"
#include "paper_figures/anchors.h"
#include "paper_figures/exemplar_pages.h"
#include "paper_figures/figure_kind.h"
#include "paper_figures/figures.h"
#include "paper_figures/ledger_page.h"
#include "paper_figures/report_changes.h"
#include "paper_figures/report_context.h"
#include "paper_figures/report_history.h"
#include "paper_figures/report_runs.h"
#include "paper_figures/templates.h"

namespace textonbench {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* report_title = "Gaussian micro-textures, measured";

std::set<std::string> missing_names(const std::vector<ReportConfig>& configs) {
  std::set<std::string> names;
  for (const ReportConfig& config : configs) {
    for (const MissingExemplar& exemplar : config.plan.missing) names.insert(exemplar.name);
  }
  return names;
}

std::string summary_of(const std::vector<ReportConfig>& configs, const std::vector<ReportRun>& runs) {
  std::set<std::string> methods, exemplars;
  for (const ReportRun& entry : runs) {
    methods.insert(entry.run.spec().method);
    exemplars.insert(entry.run.spec().exemplar);
  }
  const auto counted = [](std::size_t n, const char* noun) {
    return fmt::format("{} {}{}", n, noun, n == 1 ? "" : "s");
  };
  std::string text =
      fmt::format("{} of {} on {}: {}.", counted(configs.size(), "config"), counted(methods.size(), "method"),
                  counted(exemplars.size(), "exemplar"), in_words(count_runs(runs)));
  if (const std::size_t missing = missing_names(configs).size(); missing > 0) {
    text += fmt::format(" {} not on this machine, and {} runs were left out.",
                        missing == 1 ? "1 exemplar is" : fmt::format("{} exemplars are", missing),
                        missing == 1 ? "its" : "their");
  }
  text += " Every number and picture leads to the record that made it, and to the command that makes it again.";
  return text;
}

Json tiles_of(const std::vector<ReportConfig>& configs, const std::vector<ReportRun>& runs) {
  const RunCounts counts = count_runs(runs);
  Json tiles = Json::array();
  const auto add = [&](const char* title, std::size_t value, const char* link, bool alert) {
    tiles.push_back({{"title", title}, {"value", value}, {"link", link}, {"alert", alert && value > 0}});
  };
  add("planned", counts.planned, "#records", false);
  add("recorded", counts.recorded, "#records", false);
  add("failed", counts.failed, "#problems", true);
  add("refused", counts.refused, "#problems", false);
  add("not run yet", counts.missing, "#problems", true);
  add("exemplars not here", missing_names(configs).size(), "#problems", false);
  return tiles;
}

Json picture_note(int side) {
  if (side == 0) return nullptr;
  return fmt::format(
      "To keep this page small, pictures larger than {0} × {0} pixels are shown by their central part, pixel for "
      "pixel, "
      "and spectra are shrunk to that size. Records link to the whole files.",
      side);
}

Json files_of(const FigureOutcome& outcome) {
  Json files = Json::array();
  for (const std::filesystem::path& file : outcome.files) {
    const std::string name = file.filename().string();
    const bool own = name.starts_with(outcome.name);
    files.push_back({{"href", "../" + file.generic_string()}, {"name", own ? name.substr(outcome.name.size()) : name}});
  }
  return files;
}

/// Figures of one config, numbered from `number` on.
Json figures_of(const ReportConfig& config, const std::vector<Record>& records, const ResultsFolder& results,
                PictureStore& pictures, std::size_t& number) {
  const FigureSummary summary = make_figures(config.config, config.plan, results);
  Json views = Json::array();
  for (std::size_t i = 0; i < summary.figures.size(); ++i) {
    const FigureTable& table = config.config.figures[i];
    const FigureOutcome& outcome = summary.figures[i];
    const std::string anchor = figure_anchor(config.config, table);
    std::string body;
    if (outcome.refused.empty()) {
      const std::vector<SelectedRun> runs = select_runs(table, config.plan, records);
      const std::filesystem::path stem = results.path() / figures_folder(config.config) / table.name;
      body = find_figure_kind(table).html({table, runs, anchor}, pictures, stem);
    }
    views.push_back({{"anchor", anchor},
                     {"title", table.title},
                     {"number", number++},
                     {"caption", table.caption},
                     {"refused", or_null(outcome.refused)},
                     {"body", std::move(body)},
                     {"has_files", !outcome.files.empty()},
                     {"files", files_of(outcome)}});
  }
  return views;
}

Json sections_of(bool has_speed, bool has_changes, bool has_history) {
  Json sections = Json::array();
  if (has_speed) sections.push_back({{"anchor", "speed"}, {"title", "Speed"}});
  sections.push_back({{"anchor", "problems"}, {"title", "Failures, refusals and gaps"}});
  if (has_changes) sections.push_back({{"anchor", "changes"}, {"title", "Since the baseline"}});
  if (has_history) sections.push_back({{"anchor", "history"}, {"title", "History"}});
  sections.push_back({{"anchor", "exemplars"}, {"title", "Exemplars"}});
  sections.push_back({{"anchor", "environment"}, {"title", "Environment"}});
  sections.push_back({{"anchor", "records"}, {"title", "Records"}});
  return sections;
}

}  // namespace

std::filesystem::path write_report(const std::vector<ReportConfig>& configs, const ExemplarCatalog& exemplars,
                                   const ResultsFolder& results) {
  const ReadRecords read = results.read();
  const std::vector<ReportRun> runs = report_runs(configs, read.records);
  PictureStore pictures(results);
  Json views = Json::array();
  std::size_t number = 1;
  for (const ReportConfig& config : configs) {
    const Config& c = config.config;
    views.push_back({{"anchor", config_anchor(c)},
                     {"title", c.title},
                     {"source", c.source},
                     {"description", or_null(c.description)},
                     {"counts", c.name + ": " + in_words(count_runs(report_runs({config}, read.records)))},
                     {"figures", figures_of(config, read.records, results, pictures, number)}});
  }
  const std::filesystem::path benchmarks = results.path() / "benchmarks.json";
  const std::string speed = std::filesystem::exists(benchmarks) ? speed_html(read_file(benchmarks)) : "";
  const std::string changes = changes_html(results);
  const std::string history = history_html(results.path() / "baseline" / "history.jsonl");
  const std::string exemplars_section = exemplars_html(runs, exemplars, pictures, write_exemplar_pages(runs, results));
  const int side = pictures.fitting_side();
  const std::string page =
      render_template("report", {{"title", report_title},
                                 {"css", template_file("report.css")},
                                 {"js", template_file("report.js")},
                                 {"viewer", template_file("viewer.html")},
                                 {"summary", summary_of(configs, runs)},
                                 {"has_ledger", std::filesystem::exists(ledger_page(results))},
                                 {"picture_note", picture_note(side)},
                                 {"tiles", tiles_of(configs, runs)},
                                 {"configs", std::move(views)},
                                 {"sections", sections_of(!speed.empty(), !changes.empty(), !history.empty())},
                                 {"speed", speed},
                                 {"problems", problems_html(runs, configs, read.bad_lines)},
                                 {"changes", changes},
                                 {"history", history},
                                 {"exemplars", exemplars_section},
                                 {"environment", environment_html(runs)},
                                 {"records", records_html(runs, pictures)}});
  std::filesystem::path file = results.path() / "report" / "index.html";
  std::filesystem::create_directories(file.parent_path());
  write_atomically(file, pictures.embed(page, side));
  return file;
}

}  // namespace textonbench
