#include "paper_figures/chart.h"

#include <fmt/format.h>

#include "experiments/files.h"
#include "paper_figures/chart_script.h"
#include "paper_figures/gnuplot.h"
#include "paper_figures/number_format.h"
#include "paper_figures/templates.h"

namespace textonbench {
namespace {

const MetricEntry& metric_option(const FigureInput& input) {
  const auto found = input.table.options.find("metric");
  if (found == input.table.options.end()) {
    throw ConfigError(input.table.place, fmt::format("chart \"{}\" needs metric = \"…\"", input.table.name));
  }
  return require_metric(input, "metric", to_string(found->second));
}

bool is_logarithmic(const FigureTable& table) {
  const auto found = table.options.find("scale");
  const std::string scale = found == table.options.end() ? "linear" : to_string(found->second);
  if (scale != "linear" && scale != "log") {
    throw ConfigError(place_of(table, "scale"), fmt::format("scale = \"{}\": expected \"linear\" or \"log\"", scale));
  }
  return scale == "log";
}

std::string hover_text(const ChartContents& chart, const ChartPoint& point, std::size_t runs) {
  const std::string unit = unit_of(*chart.metric);
  std::string text = fmt::format("{} on {}: {}", chart.series[point.series], chart.rows[point.row],
                                 format_plain(*point.number.value, point.number.error));
  if (!unit.empty()) text += " " + unit;
  if (point.number.floor) text += fmt::format(", floor {}", format_number(*point.number.floor));
  if (runs > 1) text += fmt::format(", mean of {} seeds", runs);
  return text;
}

ChartGap gap_of(std::size_t row, std::size_t series, const std::vector<const SelectedRun*>& runs) {
  for (const SelectedRun* run : runs) {
    if (!run->ok()) return {row, series, run->status(), run->reason()};
  }
  return {row, series, "not defined", "not defined for this method"};
}

}  // namespace

ChartContents fill_chart(const FigureInput& input) {
  ChartContents chart;
  chart.metric = &metric_option(input);
  chart.logarithmic = is_logarithmic(input.table);
  chart.rows = exemplars_of(input.runs);
  const std::vector<RunGroup> groups = labelled_groups(input);
  for (const RunGroup& group : groups) chart.series.push_back(group.title);
  for (std::size_t series = 0; series < groups.size(); ++series) {
    for (std::size_t row = 0; row < chart.rows.size(); ++row) {
      const std::vector<const SelectedRun*> runs = groups[series].on(chart.rows[row]);
      ChartPoint point{.row = row, .series = series, .number = average_over_seeds(runs, chart.metric->name)};
      if (runs.empty()) continue;
      if (!point.number.value) {
        chart.gaps.push_back(gap_of(row, series, runs));
      } else if (chart.logarithmic && *point.number.value <= 0) {
        const std::string value = format_number(*point.number.value);
        chart.gaps.push_back({row, series, value, value + " cannot be drawn on a logarithmic axis"});
      } else {
        point.record = runs.front()->planned->id;
        point.hover = hover_text(chart, point, runs.size());
        chart.points.push_back(std::move(point));
      }
    }
  }
  return chart;
}

void check_chart(const FigureInput& input) {
  require_known_keys(input.table, {"metric", "scale"}, {"labels"}, {});
  check_labels(input.table);
  fill_chart(input);
}

std::vector<std::filesystem::path> write_chart(const FigureInput& input, const ResultsFolder& /*results*/,
                                               const std::filesystem::path& stem) {
  const ChartContents chart = fill_chart(input);
  const std::filesystem::path script = with_suffix(stem, ".gp");
  const std::filesystem::path svg = with_suffix(stem, ".svg");
  const std::filesystem::path pdf = with_suffix(stem, ".pdf");
  write_atomically(script, chart_script(chart, stem.filename().string()));
  run_gnuplot(script);
  std::vector<PointNote> notes;
  notes.reserve(chart.points.size());
  for (const ChartPoint& point : chart.points) notes.push_back({point.record, point.hover});
  write_atomically(svg, annotated_svg(read_file(svg), notes));
  write_atomically(pdf, undated_pdf(read_file(pdf)));
  return {svg, pdf, script};
}

std::string chart_html(const FigureInput& input, PictureStore& /*pictures*/, const std::filesystem::path& stem) {
  const ChartContents chart = fill_chart(input);
  nlohmann::ordered_json gaps = nlohmann::ordered_json::array();
  for (const ChartGap& gap : chart.gaps) {
    gaps.push_back(fmt::format("{} on {}: {}", chart.series[gap.series], chart.rows[gap.row], gap.reason));
  }
  return render_template("chart", {{"svg", linked_svg(read_file(with_suffix(stem, ".svg")), input.anchor)},
                                   {"title", input.table.title},
                                   {"has_gaps", !gaps.empty()},
                                   {"gaps", std::move(gaps)}});
}

}  // namespace textonbench
