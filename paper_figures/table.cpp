#include "paper_figures/table.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/files.h"
#include "paper_figures/number_format.h"
#include "paper_figures/templates.h"

namespace textonbench {
namespace {

using Json = nlohmann::ordered_json;

std::string csv_number(const std::optional<double>& value) { return value ? format_exact(*value) : ""; }

std::string csv_line(const std::vector<std::string>& fields) {
  std::vector<std::string> quoted;
  quoted.reserve(fields.size());
  std::ranges::transform(fields, std::back_inserter(quoted), csv_field);
  return fmt::format("{}\r\n", fmt::join(quoted, ","));
}

std::string summary_csv(const TableContents& table) {
  std::vector<std::string> header{"row", "detail", "exemplars"};
  for (const MetricEntry* metric : table.metrics) {
    for (const char* suffix : {"", "_stderr", "_spread", "_floor", "_exemplars"}) {
      header.push_back(std::string(metric->name) + suffix);
    }
  }
  std::string csv = csv_line(header);
  for (const TableRow& row : table.rows) {
    std::vector<std::string> fields{row.group.title, row.group.detail, std::to_string(row.exemplars)};
    for (const Average& cell : row.cells) {
      for (const auto& number : {cell.value, cell.error, cell.spread, cell.floor}) fields.push_back(csv_number(number));
      fields.push_back(std::to_string(cell.count));
    }
    csv += csv_line(fields);
  }
  return csv;
}

std::string records_csv(const TableContents& table) {
  std::vector<std::string> header{"row", "exemplar", "seed", "record", "status", "reason"};
  for (const MetricEntry* metric : table.metrics) {
    for (const char* suffix : {"", "_stderr", "_floor"}) header.push_back(std::string(metric->name) + suffix);
  }
  std::string csv = csv_line(header);
  for (const TableRow& row : table.rows) {
    for (const SelectedRun* run : row.group.runs) {
      std::vector<std::string> fields{row.group.title,  run->spec().exemplar, std::to_string(run->spec().seed),
                                      run->planned->id, run->status(),        run->reason()};
      for (const MetricEntry* metric : table.metrics) {
        const Average cell = metric_of(*run, metric->name);
        for (const auto& number : {cell.value, cell.error, cell.floor}) fields.push_back(csv_number(number));
      }
      csv += csv_line(fields);
    }
  }
  return csv;
}

Json cell_view(const Average& cell, std::size_t exemplars) {
  if (!cell.value) return {{"value", "–"}, {"sort", nullptr}, {"error", nullptr}, {"remarks", Json::array()}};
  const FormattedValue text = format_value(*cell.value, cell.error);
  Json remarks = Json::array();
  if (cell.spread) remarks.push_back("spread " + format_number(*cell.spread, 3));
  if (cell.floor) remarks.push_back("floor " + format_number(*cell.floor, 3));
  if (cell.count < exemplars) remarks.push_back(fmt::format("{} of {} exemplars", cell.count, exemplars));
  return {{"value", text.value},
          {"sort", format_exact(*cell.value)},
          {"error", or_null(text.error)},
          {"remarks", std::move(remarks)}};
}

Json record_row_view(const SelectedRun& run, bool leading, const std::vector<const MetricEntry*>& metrics) {
  Json cells = Json::array();
  for (const MetricEntry* metric : metrics) cells.push_back(cell_view(metric_of(run, metric->name), 1));
  return {{"title", fmt::format("{}, seed {}", run.spec().exemplar, run.spec().seed)},
          {"record", run.planned->id},
          {"leading", leading},
          {"reason", or_null(run.reason())},
          {"cells", std::move(cells)}};
}

Json row_view(const TableRow& row, const std::string& id, const std::vector<const MetricEntry*>& metrics) {
  Json cells = Json::array();
  for (const Average& cell : row.cells) cells.push_back(cell_view(cell, row.exemplars));
  Json records = Json::array();
  for (const SelectedRun* run : row.group.runs) records.push_back(record_row_view(*run, records.empty(), metrics));
  const std::size_t runs = row.group.runs.size();
  const RunSpec& first = row.group.runs.front()->spec();
  return {{"title", row.group.title},
          {"detail", row.group.detail},
          {"extent", runs == 1 ? fmt::format("on {}, seed {}", first.exemplar, first.seed)
                               : fmt::format("mean of {} runs on {} exemplar{}", runs, row.exemplars,
                                             row.exemplars == 1 ? "" : "s")},
          {"many", runs > 1},
          {"group", id},
          {"first", row.group.runs.front()->planned->id},
          {"notes", row.notes},
          {"cells", std::move(cells)},
          {"records", std::move(records)}};
}

std::string arrow_of(const MetricEntry& metric) {
  switch (metric.better) {
    case Better::lower:
      return "↓";
    case Better::higher:
      return "↑";
    case Better::nearer_zero:
      return "→0";
    case Better::neither:
      break;
  }
  return "";
}

Json table_view(const FigureInput& input, bool linked) {
  const TableContents table = fill_table(input);
  Json columns = Json::array();
  for (const MetricEntry* metric : table.metrics) {
    columns.push_back({{"title", metric->title},
                       {"unit", or_null(unit_of(*metric))},
                       {"direction", or_null(direction_of(*metric))},
                       {"arrow", or_null(arrow_of(*metric))},
                       {"name", metric->name}});
  }
  Json rows = Json::array();
  for (const TableRow& row : table.rows) {
    rows.push_back(row_view(row, fmt::format("{}.{}", input.anchor, rows.size()), table.metrics));
  }
  return {
      {"linked", linked}, {"caption", input.table.title}, {"columns", std::move(columns)}, {"rows", std::move(rows)}};
}

}  // namespace

TableContents fill_table(const FigureInput& input) {
  TableContents table;
  const auto asked = input.table.arrays.find("metrics");
  if (asked == input.table.arrays.end()) {
    table.metrics = measured_metrics(input);
  } else {
    for (const ParamValue& name : asked->second) {
      table.metrics.push_back(&require_metric(input, "metrics", to_string(name)));
    }
  }
  for (RunGroup& group : labelled_groups(input)) {
    TableRow row{.group = std::move(group)};
    std::vector<std::string_view> exemplars;
    for (const SelectedRun* run : row.group.runs) {
      const std::string_view exemplar = run->spec().exemplar;
      if (std::ranges::find(exemplars, exemplar) == exemplars.end()) exemplars.push_back(exemplar);
      if (!run->ok()) row.notes.push_back(fmt::format("{}, seed {}: {}", exemplar, run->spec().seed, run->reason()));
    }
    row.exemplars = exemplars.size();
    for (const MetricEntry* metric : table.metrics) {
      row.cells.push_back(average_over_exemplars(row.group, metric->name));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

void check_table(const FigureInput& input) {
  require_known_keys(input.table, {}, {"labels"}, {"metrics"});
  check_labels(input.table);
  fill_table(input);
}

std::vector<std::filesystem::path> write_table(const FigureInput& input, const ResultsFolder& /*results*/,
                                               const std::filesystem::path& stem) {
  const TableContents table = fill_table(input);
  std::vector<std::filesystem::path> files{with_suffix(stem, ".csv"), with_suffix(stem, "_records.csv"),
                                           with_suffix(stem, ".html")};
  write_atomically(files[0], summary_csv(table));
  write_atomically(files[1], records_csv(table));
  write_atomically(files[2], render_template("table", table_view(input, false)));
  return files;
}

std::string table_html(const FigureInput& input, PictureStore& /*pictures*/, const std::filesystem::path& /*stem*/) {
  return render_template("table", table_view(input, true));
}

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace textonbench
