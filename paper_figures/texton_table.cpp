#include "paper_figures/texton_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "experiments/files.h"
#include "experiments/statistics/crossing.h"
#include "paper_figures/groups.h"
#include "paper_figures/metric_choice.h"
#include "paper_figures/number_format.h"
#include "paper_figures/table.h"
#include "paper_figures/templates.h"

namespace textonbench {
namespace {

using TableJson = nlohmann::ordered_json;

constexpr std::array known_columns{
    TextonColumn{"rme", "RME", "↓"},
    TextonColumn{"rme_bound", "Bound", ""},
    TextonColumn{"gap", "Gap", "↓"},
    TextonColumn{"gap_squared", "Gap in RME²", "↓"},
    TextonColumn{"kept_variance", "Kept variance", "↑"},
    TextonColumn{"kernel_kurtosis", "Kurtosis of the kernel", "↓"},
    TextonColumn{"poisson_impacts", "Impacts for |kurtosis| < 0.1, Poisson", "↓"},
    TextonColumn{"stratified_impacts", "… stratified", "↓"},
    TextonColumn{"poisson_patch_impacts", "Impacts for twice the patch floor, Poisson", "↓"},
    TextonColumn{"stratified_patch_impacts", "… stratified", "↓"}};

constexpr const char* bound_metric = "rme_bound";
constexpr const char* patch_metric = "limit_patch_distance";

/// Whether exemplars differ by factors, so that their mean is geometric.
bool has_geometric_mean(std::string_view column) { return column.ends_with("_impacts") || column == "kernel_kurtosis"; }

bool measures(const SelectedRun& run, std::string_view metric) {
  return std::ranges::find(run.spec().metrics, metric) != run.spec().metrics.end();
}

bool same_support(const RunSpec& a, const RunSpec& b) {
  return std::ranges::all_of(std::array{"support", "shape", "mask"}, [&](const char* name) {
    const auto of_a = a.params.find(name), of_b = b.params.find(name);
    return of_a != a.params.end() && of_b != b.params.end() && of_a->second == of_b->second;
  });
}

std::optional<double> bound_of(const FigureInput& input, const RunSpec& spec) {
  for (const SelectedRun& run : input.runs) {
    if (measures(run, bound_metric) && run.spec().exemplar == spec.exemplar && same_support(run.spec(), spec)) {
      if (const Average bound = metric_of(run, bound_metric); bound.value) return bound.value;
    }
  }
  return std::nullopt;
}

/// Crossing of twice the floor by the runs with these impacts.
TextonCell patch_impacts(const std::vector<const SelectedRun*>& runs, const std::string& impacts) {
  std::map<double, std::vector<const SelectedRun*>> by_mni;
  for (const SelectedRun* run : runs) {
    const auto& params = run->spec().params;
    const auto process = params.find("impacts");
    const auto mni = params.find("mni");
    if (process == params.end() || mni == params.end() || to_string(process->second) != impacts) continue;
    if (const auto* number = std::get_if<double>(&mni->second)) by_mni[*number].push_back(run);
  }
  std::vector<MeasuredPoint> points;
  points.reserve(by_mni.size());
  for (const auto& [mni, of_mni] : by_mni) {
    const Average distance = average_over_seeds(of_mni, patch_metric);
    if (!distance.value || !distance.floor || *distance.value <= 0 || *distance.floor <= 0) continue;
    points.push_back({mni, *distance.value / *distance.floor, distance.error.value_or(0) / *distance.floor});
  }
  TextonCell cell;
  if (points.empty()) return cell;
  const Estimate crossing = log_log_crossing(points, 2);
  cell.fewest = points.front().x;
  cell.most = points.back().x;
  cell.below = crossing.value == 0 ? 1 : 0;
  cell.above = std::isinf(crossing.value) ? 1 : 0;
  if (cell.below + cell.above == 0) cell.number = crossing;
  return cell;
}

TextonCell plain_cell(const std::optional<double>& value) {
  TextonCell cell;
  if (value) cell.number = Estimate{*value, *value, *value};
  return cell;
}

TextonLine exemplar_line(const FigureInput& input, const RunGroup& group, const std::string& exemplar) {
  const std::vector<const SelectedRun*> runs = group.on(exemplar);
  const std::optional<double> rme = average_over_seeds(runs, "rme").value;
  const std::optional<double> bound = bound_of(input, runs.front()->spec());
  TextonLine line{.exemplar = exemplar, .record = runs.front()->planned->id, .cells = {}};
  for (const TextonColumn& column : known_columns) {
    if (column.name == bound_metric) {
      line.cells.push_back(plain_cell(bound));
    } else if (column.name == "gap") {
      line.cells.push_back(plain_cell(rme && bound ? std::optional(*rme - *bound) : std::nullopt));
    } else if (column.name == "gap_squared") {
      line.cells.push_back(plain_cell(rme && bound ? std::optional(*rme * *rme - *bound * *bound) : std::nullopt));
    } else if (column.name == "poisson_patch_impacts") {
      line.cells.push_back(patch_impacts(runs, "poisson"));
    } else if (column.name == "stratified_patch_impacts") {
      line.cells.push_back(patch_impacts(runs, "stratified"));
    } else {
      line.cells.push_back(plain_cell(average_over_seeds(runs, column.name).value));
    }
  }
  return line;
}

/// Mean over exemplars, with the least and greatest of them.
TextonCell mean_cell(const std::vector<TextonLine>& lines, std::size_t column) {
  const bool geometric = has_geometric_mean(known_columns.at(column).name);
  TextonCell mean;
  double sum = 0, least = std::numeric_limits<double>::infinity(), greatest = -least;
  std::size_t count = 0;
  for (const TextonLine& line : lines) {
    const TextonCell& cell = line.cells[column];
    mean.below += cell.below;
    mean.above += cell.above;
    if (cell.most > 0) {
      mean.fewest = mean.most > 0 ? std::min(mean.fewest, cell.fewest) : cell.fewest;
      mean.most = std::max(mean.most, cell.most);
    }
    if (!cell.number) continue;
    const double value = cell.number->value;
    sum += geometric ? std::log(value) : value;
    least = std::min(least, value);
    greatest = std::max(greatest, value);
    ++count;
  }
  if (count == 0) return mean;
  sum /= static_cast<double>(count);
  mean.number = {geometric ? std::exp(sum) : sum, least, greatest};
  return mean;
}

std::string bound_text(double bound) { return std::isinf(bound) ? "∞" : format_number(bound, 3); }

TableJson texton_cell_view(const TextonCell& cell, std::size_t exemplars) {
  TableJson remarks = TableJson::array();
  std::string text = "–";
  if (cell.number) {
    text = format_number(cell.number->value, 4);
    if (cell.number->low < cell.number->high && std::isfinite(cell.number->value) &&
        (std::isfinite(cell.number->low) || std::isfinite(cell.number->high))) {
      remarks.push_back(fmt::format("[{}, {}]", bound_text(cell.number->low), bound_text(cell.number->high)));
    }
  } else if (cell.below + cell.above > 0 && exemplars == 1) {
    text = cell.below > 0 ? "< " + format_number(cell.fewest) : "> " + format_number(cell.most);
  }
  if (exemplars > 1) {
    if (cell.below > 0) {
      remarks.push_back(fmt::format("without {} of {} below {}", cell.below, exemplars, format_number(cell.fewest)));
    }
    if (cell.above > 0) {
      remarks.push_back(fmt::format("without {} of {} above {}", cell.above, exemplars, format_number(cell.most)));
    }
  }
  return {{"value", text},
          {"sort", cell.number ? TableJson(format_exact(cell.number->value)) : TableJson(nullptr)},
          {"error", nullptr},
          {"remarks", std::move(remarks)}};
}

TableJson line_cells(const TextonLine& line, std::size_t exemplars) {
  TableJson cells = TableJson::array();
  for (const TextonCell& cell : line.cells) cells.push_back(texton_cell_view(cell, exemplars));
  return cells;
}

TableJson texton_table_view(const FigureInput& input, bool linked) {
  TableJson headers = TableJson::array();
  for (const TextonColumn& column : known_columns) {
    headers.push_back({{"title", column.title},
                       {"unit", nullptr},
                       {"direction", column.arrow == "↓"   ? TableJson("lower is better")
                                     : column.arrow == "↑" ? TableJson("higher is better")
                                                           : TableJson(nullptr)},
                       {"arrow", or_null(std::string(column.arrow))},
                       {"name", column.name}});
  }
  TableJson rows = TableJson::array();
  for (const TextonRow& row : fill_texton_table(input)) {
    TableJson records = TableJson::array();
    for (const TextonLine& line : row.exemplars) {
      records.push_back({{"title", line.exemplar},
                         {"record", line.record},
                         {"leading", records.empty()},
                         {"reason", nullptr},
                         {"cells", line_cells(line, 1)}});
    }
    const std::size_t count = row.exemplars.size();
    rows.push_back(
        {{"title", row.title},
         {"detail", row.detail},
         {"extent", count == 1 ? "on " + row.exemplars.front().exemplar : fmt::format("mean of {} exemplars", count)},
         {"many", count > 1},
         {"group", fmt::format("{}.{}", input.anchor, rows.size())},
         {"first", row.mean.record},
         {"notes", row.notes},
         {"cells", line_cells(count == 1 ? row.exemplars.front() : row.mean, count)},
         {"records", std::move(records)}});
  }
  return {
      {"linked", linked}, {"caption", input.table.title}, {"columns", std::move(headers)}, {"rows", std::move(rows)}};
}

std::string texton_csv(const std::vector<TextonRow>& rows) {
  std::string csv = "row,exemplar";
  for (const TextonColumn& column : known_columns) csv += fmt::format(",{0},{0}_low,{0}_high", column.name);
  csv += "\r\n";
  const auto add = [&](const TextonRow& row, const TextonLine& line) {
    csv += csv_field(row.title) + "," + csv_field(line.exemplar.empty() ? "mean" : line.exemplar);
    for (const TextonCell& cell : line.cells) {
      csv += cell.number ? fmt::format(",{},{},{}", format_exact(cell.number->value), format_exact(cell.number->low),
                                       format_exact(cell.number->high))
                         : ",,,";
    }
    csv += "\r\n";
  };
  for (const TextonRow& row : rows) {
    for (const TextonLine& line : row.exemplars) add(row, line);
    add(row, row.mean);
  }
  return csv;
}

}  // namespace

std::vector<TextonColumn> texton_columns() { return {known_columns.begin(), known_columns.end()}; }

std::vector<TextonRow> fill_texton_table(const FigureInput& input) {
  std::vector<TextonRow> rows;
  for (const RunGroup& group : labelled_groups(input, {"impacts", "mni"})) {
    if (measures(*group.runs.front(), bound_metric)) continue;
    TextonRow row{.title = group.title, .detail = group.detail, .mean = {}, .exemplars = {}, .notes = {}};
    for (const SelectedRun* run : group.runs) {
      const std::string& exemplar = run->spec().exemplar;
      if (std::ranges::find(row.exemplars, exemplar, &TextonLine::exemplar) == row.exemplars.end()) {
        row.exemplars.push_back(exemplar_line(input, group, exemplar));
      }
      if (!run->ok()) row.notes.push_back(fmt::format("{}: {}", describe(*run), run->reason()));
    }
    row.mean.record = row.exemplars.front().record;
    for (std::size_t column = 0; column < known_columns.size(); ++column) {
      row.mean.cells.push_back(mean_cell(row.exemplars, column));
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

void check_texton_table(const FigureInput& input) {
  require_known_keys(input.table, {}, {"labels"}, {});
  check_labels(input.table);
  for (const char* metric : {"rme", bound_metric}) require_metric(input, "runs", metric);
}

std::vector<std::filesystem::path> write_texton_table(const FigureInput& input, const ResultsFolder& /*results*/,
                                                      const std::filesystem::path& stem) {
  std::vector<std::filesystem::path> files{with_suffix(stem, ".csv"), with_suffix(stem, ".html")};
  write_atomically(files[0], texton_csv(fill_texton_table(input)));
  write_atomically(files[1], render_template("table", texton_table_view(input, false)));
  return files;
}

std::string texton_table_html(const FigureInput& input, PictureStore& /*pictures*/,
                              const std::filesystem::path& /*stem*/) {
  return render_template("table", texton_table_view(input, true));
}

}  // namespace textonbench
