#include "paper_figures/exemplar_pages.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>

#include "experiments/files.h"
#include "experiments/metrics/metric.h"
#include "paper_figures/anchors.h"
#include "paper_figures/equal_cost.h"
#include "paper_figures/number_format.h"
#include "paper_figures/picture_store.h"
#include "paper_figures/templates.h"

namespace textonbench {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array shown_metrics{"smoothed_rme",   "rme",          "log_spectral_distance", "color_covariance_error",
                                   "patch_distance", "ns_per_pixel", "operations_per_pixel",  "model_bytes",
                                   "analyze_seconds"};

std::string page_name(const std::string& exemplar) { return fmt::format("exemplar_{}.html", anchor_text(exemplar)); }

Extent size_of(const Record& picture) { return {picture.at("width").get<int>(), picture.at("height").get<int>()}; }

/// `width` is that of the widest picture beside it: all pictures of a row have one scale.
Json picture_cell(const Record& picture, int width, PictureStore& pictures, const std::string& label,
                  const std::string& note, const std::string& record) {
  const auto key = pictures.show(picture, PictureFit::window);
  return {{"picture", key ? Json(*key) : Json(nullptr)},
          {"percent", std::min(100, 100 * size_of(picture).width / std::max(width, 1))},
          {"label", label},
          {"note", or_null(note)},
          {"record", or_null(record)}};
}

const Record& sample_of(const CostedRun& run) { return run.entry->run.record->at("pictures").at("sample"); }

std::string cost_note(const CostedRun& run) {
  const auto error = value_of(*run.entry, "smoothed_rme");
  const std::string error_text = error
                                     ? fmt::format("smoothed RME {}", format_number(*error, 3))
                                     : fmt::format("RME {}", format_number(value_of(*run.entry, "rme").value_or(0), 3));
  return fmt::format("{}, {} operations a pixel", error_text, format_number(run.operations, 3));
}

Json table_of(const CostLevel& level) {
  Json columns = Json::array(), rows = Json::array();
  std::vector<std::string> metrics;
  for (const char* name : shown_metrics) {
    if (std::ranges::none_of(level.runs,
                             [&](const CostedRun& run) { return value_of(*run.entry, name).has_value(); })) {
      continue;
    }
    metrics.emplace_back(name);
    const MetricEntry& metric = find_metric(name);
    columns.push_back({{"title", metric.title}, {"unit", metric.unit == "1" ? Json(nullptr) : Json(metric.unit)}});
  }
  for (const CostedRun& run : level.runs) {
    Json cells = Json::array();
    for (const std::string& name : metrics) {
      const auto value = value_of(*run.entry, name);
      cells.push_back({{"value", value ? format_number(*value) : "–"},
                       {"sort", value ? Json(format_exact(*value)) : Json(nullptr)}});
    }
    rows.push_back({{"method", run.entry->run.spec().method},
                    {"label", run.entry->run.label},
                    {"record", record_anchor(run.entry->run.planned->id)},
                    {"cells", std::move(cells)}});
  }
  return {{"columns", std::move(columns)}, {"rows", std::move(rows)}};
}

Json view_of(const CostLevel& level, const Record& exemplar_picture, PictureStore& pictures) {
  Json cells = Json::array();
  const int width = size_of(sample_of(level.runs.front())).width;
  if (exemplar_picture.is_object()) {
    cells.push_back(picture_cell(exemplar_picture, width, pictures, "Exemplar", "", ""));
  }
  for (const CostedRun& run : level.runs) {
    const SelectedRun& selected = run.entry->run;
    cells.push_back(picture_cell(sample_of(run), width, pictures, selected.spec().method, cost_note(run),
                                 record_anchor(selected.planned->id)));
  }
  std::vector<std::string> absent;
  absent.reserve(level.absent.size());
  for (const CostLevel::Absent& method : level.absent) {
    absent.push_back(fmt::format("{} ({})", method.method, format_number(method.nearest, 3)));
  }
  return {{"anchor", fmt::format("at-{:.0f}", level.budget)},
          {"title", fmt::format("About {:.0f} operations a pixel", level.budget)},
          {"from", fmt::format("{:g}", level.budget / 2)},
          {"to", fmt::format("{:g}", level.budget * 2)},
          {"columns_count", cells.size()},
          {"cells", std::move(cells)},
          {"absent", or_null(fmt::format("{}", fmt::join(absent, ", ")))},
          {"table", table_of(level)}};
}

/// The exemplar as a record shows it, if one does.
Record picture_of_exemplar(const std::vector<ReportRun>& runs, const std::string& exemplar) {
  for (const ReportRun& entry : runs) {
    if (entry.run.spec().exemplar != exemplar || !entry.run.ok()) continue;
    const Record pictures = entry.run.record->value("pictures", Record::object());
    if (pictures.contains("exemplar")) return pictures.at("exemplar");
  }
  return nullptr;
}

void remove_old_pages(const std::filesystem::path& folder, const std::map<std::string, std::string>& pages) {
  std::set<std::string> kept;
  for (const auto& [exemplar, page] : pages) kept.insert(page);
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("exemplar_") && name.ends_with(".html") && !kept.contains(name)) {
      std::filesystem::remove(entry.path());
    }
  }
}

}  // namespace

std::map<std::string, std::string> write_exemplar_pages(const std::vector<ReportRun>& runs,
                                                        const ResultsFolder& results) {
  std::set<std::string> exemplars;
  for (const ReportRun& entry : runs) exemplars.insert(entry.run.spec().exemplar);
  const std::filesystem::path folder = results.path() / "report";
  std::filesystem::create_directories(folder);
  std::map<std::string, std::string> pages;
  for (const std::string& exemplar : exemplars) {
    const std::vector<CostLevel> levels = cost_levels(costed_runs(runs, exemplar));
    if (levels.empty()) continue;
    PictureStore pictures(results);
    const Record picture = picture_of_exemplar(runs, exemplar);
    Json views = Json::array();
    for (const CostLevel& level : levels) views.push_back(view_of(level, picture, pictures));
    const std::string page = render_template("exemplar_page", {{"exemplar", exemplar},
                                                               {"anchor", exemplar_anchor(exemplar)},
                                                               {"css", template_file("report.css")},
                                                               {"js", template_file("report.js")},
                                                               {"viewer", template_file("viewer.html")},
                                                               {"levels", std::move(views)}});
    pages[exemplar] = page_name(exemplar);
    // No larger than the samples, so that a larger exemplar is shown by its middle.
    const Extent sample = size_of(sample_of(levels.front().runs.front()));
    const int fitting = pictures.fitting_side(), side = std::max(sample.width, sample.height);
    write_atomically(folder / pages[exemplar], pictures.embed(page, fitting > 0 ? std::min(fitting, side) : side));
  }
  remove_old_pages(folder, pages);
  return pages;
}

}  // namespace textonbench
