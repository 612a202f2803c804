#include "paper_figures/curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "experiments/files.h"
#include "paper_figures/gnuplot.h"
#include "paper_figures/number_format.h"
#include "paper_figures/templates.h"

namespace textonbench {
namespace {

constexpr int curve_replicates = 4000;

std::string curve_option(const FigureInput& input, const std::string& key, std::initializer_list<const char*> allowed) {
  const auto found = input.table.options.find(key);
  if (found == input.table.options.end()) return *allowed.begin();
  std::string text = to_string(found->second);
  if (std::ranges::none_of(allowed, [&](const char* value) { return text == value; })) {
    throw ConfigError(place_of(input.table, key),
                      fmt::format("{} = \"{}\": expected \"{}\"", key, text, fmt::join(allowed, "\" or \"")));
  }
  return text;
}

std::string required_curve_option(const FigureInput& input, const std::string& key) {
  const auto found = input.table.options.find(key);
  if (found == input.table.options.end()) {
    throw ConfigError(input.table.place, fmt::format("curve \"{}\" needs {} = \"…\"", input.table.name, key));
  }
  return to_string(found->second);
}

std::optional<double> number_of_param(const RunSpec& spec, const std::string& name) {
  const std::map<std::string, ParamValue> options = options_of(spec);
  const auto found = options.find(name);
  if (found == options.end()) return std::nullopt;
  if (const auto* whole = std::get_if<std::int64_t>(&found->second)) return static_cast<double>(*whole);
  if (const auto* real = std::get_if<double>(&found->second)) return *real;
  return std::nullopt;
}

/// Mean over exemplars of the means over their seeds, with what is drawn around it.
Estimate estimate_of(const Levels& levels, bool is_deviation) {
  if (!is_deviation) return bootstrap_mean(levels, 0.95, curve_replicates, Seed{1});
  double sum = 0, squares = 0;
  std::size_t count = 0;
  for (const std::vector<double>& values : levels) {
    for (const double value : values) sum += value, ++count;
  }
  const double mean = sum / static_cast<double>(count);
  for (const std::vector<double>& values : levels) {
    for (const double value : values) squares += (value - mean) * (value - mean);
  }
  const double deviation =
      count > 1 ? std::sqrt(squares / static_cast<double>(count - 1)) : std::numeric_limits<double>::infinity();
  return {mean, mean - deviation, mean + deviation};
}

/// The values at one x, by exemplar.
struct CurveCell {
  std::map<std::string, std::vector<double>> values;
  std::string record;
};

void add_line(CurveContents& curve, const std::string& title, const std::vector<const SelectedRun*>& runs) {
  std::map<double, CurveCell> cells;
  for (const SelectedRun* run : runs) {
    const double x = number_of_param(run->spec(), curve.parameter).value();
    const Average number = metric_of(*run, curve.metric->name);
    std::string problem;
    if (!run->ok()) {
      problem = run->reason();
    } else if (!number.value) {
      problem = "not defined for this method";
    } else if ((curve.logarithmic_y && *number.value <= 0) || (curve.logarithmic_x && x <= 0)) {
      problem = "a value that is not positive cannot be drawn on a logarithmic axis";
    }
    if (!problem.empty()) {
      std::string gap = fmt::format("{} on {} at {}: {}", title, run->spec().exemplar, format_exact(x), problem);
      if (std::ranges::find(curve.gaps, gap) == curve.gaps.end()) curve.gaps.push_back(std::move(gap));
      continue;
    }
    CurveCell& cell = cells[x];
    cell.values[run->spec().exemplar].push_back(*number.value);
    if (cell.record.empty()) cell.record = run->planned->id;
  }
  if (cells.empty()) return;
  CurveLine line{.title = title, .points = {}};
  for (auto& [x, cell] : cells) {
    Levels levels;
    std::size_t count = 0;
    for (auto& [exemplar, values] : cell.values) {
      count += values.size();
      levels.push_back(std::move(values));
    }
    line.points.push_back({x, estimate_of(levels, curve.is_deviation), count, cell.record});
  }
  curve.lines.push_back(std::move(line));
}

std::string in_words(const CurveContents& curve, const CurvePoint& point) {
  const std::string unit = unit_of(*curve.metric);
  std::string text = format_number(point.y.value);
  if (std::isfinite(point.y.low)) {
    text += curve.is_deviation ? fmt::format(" ± {}", format_number(point.y.high - point.y.value))
                               : fmt::format(" [{}, {}]", format_number(point.y.low), format_number(point.y.high));
  }
  return unit.empty() ? text : text + " " + unit;
}

}  // namespace

CurveContents fill_curve(const FigureInput& input) {
  CurveContents curve;
  curve.parameter = required_curve_option(input, "parameter");
  curve.metric = &require_metric(input, "metric", required_curve_option(input, "metric"));
  curve.is_deviation = curve_option(input, "band", {"interval", "deviation"}) == "deviation";
  curve.logarithmic_x = curve_option(input, "scale_x", {"linear", "log"}) == "log";
  curve.logarithmic_y = curve_option(input, "scale", {"linear", "log"}) == "log";
  const bool by_exemplar = curve_option(input, "each", {"mean", "exemplar"}) == "exemplar";
  for (const SelectedRun& run : input.runs) {
    if (!number_of_param(run.spec(), curve.parameter)) {
      throw ConfigError(
          place_of(input.table, "parameter"),
          fmt::format("parameter = \"{}\": {} has no number of this name", curve.parameter, run.spec().method));
    }
  }
  const std::vector<RunGroup> groups = labelled_groups(input, {curve.parameter});
  for (const RunGroup& group : groups) {
    if (!by_exemplar) {
      add_line(curve, group.title, group.runs);
      continue;
    }
    for (const std::string& exemplar : exemplars_of(input.runs)) {
      const std::vector<const SelectedRun*> runs = group.on(exemplar);
      if (!runs.empty()) add_line(curve, groups.size() == 1 ? exemplar : group.title + ", " + exemplar, runs);
    }
  }
  return curve;
}

void check_curve(const FigureInput& input) {
  require_known_keys(input.table, {"parameter", "metric", "band", "each", "scale_x", "scale"}, {"labels"}, {});
  check_labels(input.table);
  fill_curve(input);
}

std::vector<std::filesystem::path> write_curve(const FigureInput& input, const ResultsFolder& /*results*/,
                                               const std::filesystem::path& stem) {
  const CurveContents curve = fill_curve(input);
  const std::filesystem::path script = with_suffix(stem, ".gp");
  const std::filesystem::path svg = with_suffix(stem, ".svg");
  const std::filesystem::path pdf = with_suffix(stem, ".pdf");
  write_atomically(script, curve_script(curve, stem.filename().string()));
  run_gnuplot(script);
  std::vector<PointNote> notes;
  for (const CurveLine& line : curve.lines) {
    for (const CurvePoint& point : line.points) {
      notes.push_back({point.record, fmt::format("{}, {} = {}: {} (of {})", line.title, curve.parameter,
                                                 format_exact(point.x), in_words(curve, point), point.count)});
    }
  }
  write_atomically(svg, annotated_svg(read_file(svg), notes));
  write_atomically(pdf, undated_pdf(read_file(pdf)));
  return {svg, pdf, script};
}

std::string curve_html(const FigureInput& input, PictureStore& /*pictures*/, const std::filesystem::path& stem) {
  const CurveContents curve = fill_curve(input);
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const CurveLine& line : curve.lines) {
    for (const CurvePoint& point : line.points) {
      rows.push_back({{"title", line.title},
                      {"x", format_exact(point.x)},
                      {"x_sort", format_exact(point.x)},
                      {"y", in_words(curve, point)},
                      {"y_sort", format_exact(point.y.value)},
                      {"count", point.count},
                      {"record", point.record}});
    }
  }
  return render_template("curve", {{"svg", linked_svg(read_file(with_suffix(stem, ".svg")), input.anchor)},
                                   {"title", input.table.title},
                                   {"parameter", curve.parameter},
                                   {"metric", curve.metric->title},
                                   {"band", curve.is_deviation ? "standard deviation" : "95 % interval"},
                                   {"rows", std::move(rows)},
                                   {"has_gaps", !curve.gaps.empty()},
                                   {"gaps", curve.gaps}});
}

}  // namespace textonbench
