#include "paper_figures/panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "experiments/files.h"
#include "methods/base/image_io.h"
#include "paper_figures/anchors.h"
#include "paper_figures/metric_choice.h"
#include "paper_figures/number_format.h"
#include "paper_figures/panel_image.h"
#include "paper_figures/templates.h"

namespace textonbench {
namespace {

using Json = nlohmann::ordered_json;
using Column = std::map<std::string, ParamValue>;

constexpr std::int64_t default_cell = 256;
constexpr std::int64_t least_cell = 32;
constexpr std::int64_t largest_cell = 2048;

bool is_selector(const std::string& key) {
  return key != "run" && key != "picture" && key != "label" && key != "fit" && key != "note";
}

bool answers(const SelectedRun& run, const Column& column) {
  if (run.label != to_string(column.at("run"))) return false;
  return std::ranges::all_of(column, [&](const auto& entry) {
    return !is_selector(entry.first) || attribute_of(run.spec(), entry.first) == to_string(entry.second);
  });
}

/// The attributes in which these runs differ, for "add seed, component".
std::vector<std::string> differences(const std::vector<const SelectedRun*>& runs) {
  std::set<std::string> keys{"method", "seed", "periodic", "width", "height"};
  for (const SelectedRun* run : runs) {
    for (const auto& [name, value] : options_of(run->spec())) keys.insert(name);
  }
  std::vector<std::string> differing;
  for (const std::string& key : keys) {
    const auto first = attribute_of(runs.front()->spec(), key);
    const bool same =
        std::ranges::all_of(runs, [&](const auto* run) { return attribute_of(run->spec(), key) == first; });
    if (!same) differing.push_back(key);
  }
  return differing;
}

PanelCell cell_of(const std::vector<const SelectedRun*>& runs, const std::string& picture, PictureFit fit) {
  if (runs.empty()) return {nullptr, std::nullopt, fit, "no run in this plan"};
  const SelectedRun& run = *runs.front();
  if (!run.ok()) return {&run, std::nullopt, fit, run.reason()};
  const Record pictures = run.record->value("pictures", Record::object());
  const auto found = pictures.find(picture);
  if (found == pictures.end()) return {&run, std::nullopt, fit, "the record holds no such picture"};
  return {&run, *found, fit, ""};
}

PictureFit fit_of(const FigureTable& table, std::size_t column) {
  const Column& keys = table.lists.at("columns")[column];
  const auto found = keys.find("fit");
  const std::string fit = found == keys.end() ? "window" : to_string(found->second);
  if (fit != "window" && fit != "whole") {
    throw ConfigError(place_of(table, fmt::format("columns[{}].fit", column)),
                      fmt::format("fit = \"{}\": expected \"window\" or \"whole\"", fit));
  }
  return fit == "whole" ? PictureFit::whole : PictureFit::window;
}

/// Metric that the column's pictures are labelled with.
const MetricEntry* note_of(const FigureInput& input, std::size_t column) {
  const Column& keys = input.table.lists.at("columns")[column];
  const auto found = keys.find("note");
  if (found == keys.end()) return nullptr;
  return &require_metric(input, fmt::format("columns[{}].note", column), to_string(found->second));
}

std::string note_text(const PanelCell& cell, const MetricEntry& metric) {
  const Average number = cell.run != nullptr ? metric_of(*cell.run, metric.name) : Average{};
  if (!number.value) return "";
  const std::string name = metric.name == "rme" ? "RME" : std::string(metric.title);
  const std::string unit = unit_of(metric);
  return fmt::format("{} {}{}", name, format_number(*number.value, 3), unit.empty() ? "" : " " + unit);
}

std::int64_t cell_side(const FigureTable& table) {
  const auto found = table.options.find("cell");
  if (found == table.options.end()) return default_cell;
  const auto* side = std::get_if<std::int64_t>(&found->second);
  if (side == nullptr || *side < least_cell || *side > largest_cell) {
    throw ConfigError(place_of(table, "cell"), fmt::format("cell = {}: expected a whole number of pixels in [{}, {}]",
                                                           to_string(found->second), least_cell, largest_cell));
  }
  return *side;
}

}  // namespace

bool PanelLayout::has_notes() const {
  return std::ranges::any_of(rows, [](const PanelRow& row) {
    return std::ranges::any_of(row.cells, [](const PanelCell& cell) { return !cell.note.empty(); });
  });
}

PanelLayout lay_out_panel(const FigureInput& input) {
  const std::vector<Column>& columns = input.table.lists.at("columns");
  PanelLayout layout;
  for (const Column& column : columns) layout.columns.push_back(to_string(column.at("label")));
  for (const std::string& exemplar : exemplars_of(input.runs)) layout.rows.push_back({exemplar, {}});

  for (std::size_t i = 0; i < columns.size(); ++i) {
    const SourcePlace& place = place_of(input.table, fmt::format("columns[{}]", i));
    const std::string picture = to_string(columns[i].at("picture"));
    const PictureFit fit = fit_of(input.table, i);
    const MetricEntry* note = note_of(input, i);
    std::size_t answered = 0;
    for (PanelRow& row : layout.rows) {
      std::vector<const SelectedRun*> runs;
      for (const SelectedRun& run : input.runs) {
        if (run.spec().exemplar == row.exemplar && answers(run, columns[i])) runs.push_back(&run);
      }
      if (runs.size() > 1) {
        throw ConfigError(
            place, fmt::format("column {} (\"{}\") matches {} runs on exemplar {}: add {}", i + 1, layout.columns[i],
                               runs.size(), row.exemplar, fmt::join(differences(runs), " or ")));
      }
      if (!runs.empty() &&
          std::ranges::find(runs.front()->spec().pictures, picture) == runs.front()->spec().pictures.end()) {
        throw ConfigError(place,
                          fmt::format("run \"{}\" keeps no picture \"{}\": add it to its pictures, now [{}]",
                                      runs.front()->label, picture, fmt::join(runs.front()->spec().pictures, ", ")));
      }
      answered += runs.size();
      row.cells.push_back(cell_of(runs, picture, fit));
      if (note != nullptr) row.cells.back().note = note_text(row.cells.back(), *note);
    }
    if (answered == 0 && !layout.rows.empty()) {
      throw ConfigError(place, fmt::format("column {} (\"{}\") matches no run", i + 1, layout.columns[i]));
    }
  }
  return layout;
}

void check_panel(const FigureInput& input) {
  require_known_keys(input.table, {"cell"}, {"columns"}, {});
  const auto found = input.table.lists.find("columns");
  if (found == input.table.lists.end() || found->second.empty()) {
    throw ConfigError(
        input.table.place,
        fmt::format("panel \"{}\" needs columns = [{{run = …, picture = …, label = …}}]", input.table.name));
  }
  std::set<std::string> params;
  for (const SelectedRun& run : input.runs) {
    for (const auto& [name, value] : options_of(run.spec())) params.insert(name);
  }
  if (input.runs.empty()) {
    // None of its exemplars is here, so it is not known what may be asked of its runs.
    for (const Column& column : found->second) {
      for (const auto& [key, value] : column) params.insert(key);
    }
  }
  std::vector<std::string_view> selectors{"fit", "note", "seed", "method", "periodic", "width", "height"};
  selectors.insert(selectors.end(), params.begin(), params.end());
  constexpr std::array<std::string_view, 3> required{"run", "picture", "label"};
  require_known_columns(input.table, "columns", required, selectors);
  cell_side(input.table);
  lay_out_panel(input);
}

std::vector<std::filesystem::path> write_panel(const FigureInput& input, const ResultsFolder& results,
                                               const std::filesystem::path& stem) {
  const PanelLayout layout = lay_out_panel(input);
  const auto side = static_cast<int>(cell_side(input.table));
  const std::filesystem::path file = with_suffix(stem, ".png");
  const std::filesystem::path note = with_suffix(stem, ".inputs");
  const std::string inputs = panel_digest(layout, side, results);
  if (std::filesystem::exists(file) && std::filesystem::exists(note) && read_file(note) == inputs) return {file};
  write_image(draw_panel(layout, side, results), file);
  write_atomically(note, inputs);
  return {file};
}

std::string panel_html(const FigureInput& input, PictureStore& pictures, const std::filesystem::path& /*stem*/) {
  const PanelLayout layout = lay_out_panel(input);
  Json rows = Json::array();
  for (const PanelRow& row : layout.rows) {
    Json cells = Json::array();
    for (std::size_t i = 0; i < row.cells.size(); ++i) {
      const PanelCell& cell = row.cells[i];
      const auto key = cell.picture ? pictures.show(*cell.picture, cell.fit) : std::nullopt;
      const std::string absent = cell.picture ? std::string(lost_picture) : cell.absent;
      cells.push_back({{"label", layout.columns[i]},
                       {"exemplar", row.exemplar},
                       {"note", cell.note.empty() ? Json(nullptr) : Json(cell.note)},
                       {"record", cell.run != nullptr ? Json(cell.run->planned->id) : Json(nullptr)},
                       {"picture", key ? Json(*key) : Json(nullptr)},
                       {"absent", key ? Json(nullptr) : Json(absent)}});
    }
    rows.push_back(
        {{"name", row.exemplar}, {"exemplar_anchor", exemplar_anchor(row.exemplar)}, {"cells", std::move(cells)}});
  }
  return render_template("panel", {{"columns", layout.columns.size()}, {"rows", std::move(rows)}});
}

}  // namespace textonbench
