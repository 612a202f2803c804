#include "paper_figures/front.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/files.h"
#include "paper_figures/gnuplot.h"
#include "paper_figures/number_format.h"
#include "paper_figures/templates.h"

namespace textonbench {
namespace {

constexpr int replicates = 4000;

const MetricEntry& metric_key(const FigureInput& input, const std::string& key) {
  const auto found = input.table.options.find(key);
  if (found == input.table.options.end()) {
    throw ConfigError(input.table.place, fmt::format("front \"{}\" needs {} = \"…\"", input.table.name, key));
  }
  return require_metric(input, key, to_string(found->second));
}

const MetricEntry& ordered_metric(const FigureInput& input, const std::string& key) {
  const MetricEntry& metric = metric_key(input, key);
  if (metric.better != Better::lower && metric.better != Better::higher) {
    throw ConfigError(place_of(input.table, key),
                      fmt::format("{} = \"{}\": expected a metric of which less or more is better", key, metric.name));
  }
  return metric;
}

/// Values of both metrics where a record has both and a logarithm exists.
struct Pairs {
  Levels cost, quality;
  std::string problem;
};

Pairs pairs_of(const FrontContents& front, const std::vector<const SelectedRun*>& runs) {
  Pairs pairs{{{}}, {{}}, ""};
  for (const SelectedRun* run : runs) {
    const Average cost = metric_of(*run, front.cost->name), quality = metric_of(*run, front.quality->name);
    if (!run->ok()) {
      pairs.problem = run->reason();
    } else if (!cost.value || !quality.value) {
      pairs.problem = "not defined for this method";
    } else if (*cost.value <= 0 || (front.logarithmic && *quality.value <= 0)) {
      pairs.problem = "a value that is not positive cannot be drawn on a logarithmic axis";
    } else {
      pairs.cost[0].push_back(*cost.value);
      pairs.quality[0].push_back(*quality.value);
    }
  }
  return pairs;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

std::string with_unit(const std::string& number, const MetricEntry& metric) {
  const std::string unit = unit_of(metric);
  return unit.empty() ? number : number + " " + unit;
}

std::string in_words(const Estimate& estimate, const MetricEntry& metric) {
  if (!std::isfinite(estimate.low) || !std::isfinite(estimate.high)) {
    return with_unit(format_number(estimate.value), metric) + " (one number: no interval)";
  }
  return with_unit(fmt::format("{} [{}, {}]", format_number(estimate.value), format_number(estimate.low),
                               format_number(estimate.high)),
                   metric);
}

std::string hover_text(const FrontContents& front, const FrontPoint& point, const std::string& exemplar) {
  return fmt::format("{} on {}: {} at {}", front.series[point.series], exemplar,
                     with_unit(format_number(point.quality), *front.quality),
                     with_unit(format_number(point.cost), *front.cost));
}

/// True when `a` is at least as good as `b` in both and better in one.
bool beats(const FrontContents& front, const FrontMean& a, const FrontMean& b) {
  const auto gain = [](const MetricEntry& metric, const Estimate& x, const Estimate& y) {
    return metric.better == Better::lower ? y.value - x.value : x.value - y.value;
  };
  const double cost = gain(*front.cost, a.cost, b.cost), quality = gain(*front.quality, a.quality, b.quality);
  return cost >= 0 && quality >= 0 && (cost > 0 || quality > 0);
}

void add_group(FrontContents& front, const RunGroup& group, const std::vector<std::string>& exemplars) {
  const std::size_t series = front.series.size() - 1;
  Levels costs, qualities;
  std::string problem;
  for (const std::string& exemplar : exemplars) {
    const std::vector<const SelectedRun*> runs = group.on(exemplar);
    if (runs.empty()) continue;
    Pairs pairs = pairs_of(front, runs);
    if (!pairs.problem.empty()) problem = exemplar + ": " + pairs.problem;
    if (pairs.cost[0].empty()) continue;
    FrontPoint point{.series = series, .cost = mean_of(pairs.cost[0]), .quality = mean_of(pairs.quality[0])};
    point.record = runs.front()->planned->id;
    point.hover = hover_text(front, point, exemplar);
    front.points.push_back(std::move(point));
    costs.push_back(std::move(pairs.cost[0]));
    qualities.push_back(std::move(pairs.quality[0]));
  }
  if (!problem.empty()) front.gaps.push_back(fmt::format("{} on {}", front.series[series], problem));
  if (costs.empty()) return;
  // One seed for all groups: the intervals share their noise.
  front.means.push_back({.series = series,
                         .exemplars = costs.size(),
                         .cost = bootstrap_mean(costs, 0.95, replicates, Seed{1}),
                         .quality = bootstrap_mean(qualities, 0.95, replicates, Seed{1})});
}

}  // namespace

FrontContents fill_front(const FigureInput& input) {
  FrontContents front;
  front.cost = &ordered_metric(input, "cost");
  front.quality = &ordered_metric(input, "quality");
  const auto scale = input.table.options.find("scale");
  const std::string text = scale == input.table.options.end() ? "linear" : to_string(scale->second);
  if (text != "linear" && text != "log") {
    throw ConfigError(place_of(input.table, "scale"),
                      fmt::format("scale = \"{}\": expected \"linear\" or \"log\"", text));
  }
  front.logarithmic = text == "log";
  const std::vector<std::string> exemplars = exemplars_of(input.runs);
  const std::vector<RunGroup> groups = labelled_groups(input);
  for (const RunGroup& group : groups) {
    front.series.push_back(group.title);
    add_group(front, group, exemplars);
  }
  for (FrontMean& mean : front.means) {
    mean.on_front = std::ranges::none_of(front.means, [&](const FrontMean& b) { return beats(front, b, mean); });
  }
  return front;
}

void check_front(const FigureInput& input) {
  require_known_keys(input.table, {"cost", "quality", "scale"}, {"labels"}, {});
  check_labels(input.table);
  fill_front(input);
}

std::vector<std::filesystem::path> write_front(const FigureInput& input, const ResultsFolder& /*results*/,
                                               const std::filesystem::path& stem) {
  const FrontContents front = fill_front(input);
  const std::filesystem::path script = with_suffix(stem, ".gp");
  const std::filesystem::path svg = with_suffix(stem, ".svg");
  const std::filesystem::path pdf = with_suffix(stem, ".pdf");
  write_atomically(script, front_script(front, stem.filename().string()));
  run_gnuplot(script);
  std::vector<PointNote> notes;
  for (const FrontMean& mean : front.means) {
    const auto first = std::ranges::find(front.points, mean.series, &FrontPoint::series);
    notes.push_back(
        {first->record, fmt::format("{}, mean of {} exemplars: {} at {}", front.series[mean.series], mean.exemplars,
                                    in_words(mean.quality, *front.quality), in_words(mean.cost, *front.cost))});
  }
  for (const FrontPoint& point : front.points) notes.push_back({point.record, point.hover});
  write_atomically(svg, annotated_svg(read_file(svg), notes));
  write_atomically(pdf, undated_pdf(read_file(pdf)));
  return {svg, pdf, script};
}

std::string front_html(const FigureInput& input, PictureStore& /*pictures*/, const std::filesystem::path& stem) {
  const FrontContents front = fill_front(input);
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const FrontMean& mean : front.means) {
    rows.push_back({{"title", front.series[mean.series]},
                    {"exemplars", mean.exemplars},
                    {"cost", in_words(mean.cost, *front.cost)},
                    {"cost_sort", format_exact(mean.cost.value)},
                    {"quality", in_words(mean.quality, *front.quality)},
                    {"quality_sort", format_exact(mean.quality.value)},
                    {"front", mean.on_front ? "yes" : "no"}});
  }
  return render_template("front", {{"svg", linked_svg(read_file(with_suffix(stem, ".svg")), input.anchor)},
                                   {"title", input.table.title},
                                   {"cost_title", front.cost->title},
                                   {"quality_title", front.quality->title},
                                   {"rows", std::move(rows)},
                                   {"has_gaps", !front.gaps.empty()},
                                   {"gaps", front.gaps}});
}

}  // namespace textonbench
