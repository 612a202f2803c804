#include "paper_figures/chart_script.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "paper_figures/chart_style.h"
#include "paper_figures/gnuplot.h"

namespace textonbench {
namespace {

constexpr int axis_space = 62;
constexpr double symbol_size = 0.75;
constexpr const char* floor_style = "lw 3 lc rgb \"#a9aeb6\"";

struct Range {
  double low, high;
};

/// Ends of a point's error bar. On a logarithmic axis a bar that reaches below zero is cut a decade under its point.
Range error_bar(const ChartContents& chart, const ChartPoint& point) {
  const double value = *point.number.value, error = point.number.error.value_or(0);
  return {chart.logarithmic ? std::max(value - error, value / 10) : value - error, value + error};
}

/// Everything that must be visible: points with their error bars, and floors.
Range data_range(const ChartContents& chart) {
  Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  const auto include = [&](double x) { range = {std::min(range.low, x), std::max(range.high, x)}; };
  for (const ChartPoint& point : chart.points) {
    const Range bar = error_bar(chart, point);
    include(bar.low);
    include(bar.high);
    if (point.number.floor && (!chart.logarithmic || *point.number.floor > 0)) include(*point.number.floor);
  }
  return range.low > range.high ? Range{0, 1} : range;
}

/// Linear axes start at zero unless a value is negative; logarithmic ones leave a tenth of a decade on both sides.
Range axis_range(const ChartContents& chart) {
  const Range data = data_range(chart);
  if (chart.logarithmic) {
    if (chart.points.empty()) return {0.1, 1};
    return {data.low * 0.8, data.high * 1.25};
  }
  const double span = data.high - std::min(data.low, 0.0);
  const double margin = span > 0 ? 0.05 * span : 1;
  return {data.low < 0 ? data.low - margin : 0, data.high > 0 || data.low >= 0 ? data.high + margin : margin};
}

/// Series of one exemplar lie side by side around the exemplar's line.
double position(const ChartContents& chart, std::size_t row, std::size_t series) {
  const auto count = static_cast<double>(chart.series.size());
  const double step = std::min(0.24, 0.72 / count);
  return static_cast<double>(row) + 1 + step * (static_cast<double>(series) - (count - 1) / 2);
}

bool has_floor(const ChartContents& chart) {
  return std::ranges::any_of(chart.points, [](const ChartPoint& point) { return point.number.floor.has_value(); });
}

/// Places in SVG pixels.
struct Layout {
  int left, top, height;
  std::vector<KeyItem> key;  ///< indexed by series; chart.series.size() stands for the floor
};

Layout lay_out(const ChartContents& chart) {
  std::size_t longest = 0;
  for (const std::string& row : chart.rows) longest = std::max(longest, count_characters(row));
  const int left = std::min(24 + character_width * static_cast<int>(longest), chart_width / 2);
  std::vector<std::string> texts = chart.series;
  if (has_floor(chart)) texts.emplace_back("floor (exact Gaussian samples)");
  std::vector<KeyItem> key = lay_out_key(left, texts);
  const int top = key_height(key);
  const int row_height = std::max(26, 13 * static_cast<int>(chart.series.size()) + 12);
  const int height = top + row_height * static_cast<int>(chart.rows.size()) + axis_space;
  return {left, top, height, std::move(key)};
}

/// One block a series (value, place, ends of the error bar, label), then one of floors (value, place).
std::string data_blocks(const ChartContents& chart) {
  std::string text;
  for (std::size_t series = 0; series < chart.series.size(); ++series) {
    text += fmt::format("$series{} << EOD\n", series);
    for (std::size_t k = 0; k < chart.points.size(); ++k) {
      const ChartPoint& point = chart.points[k];
      if (point.series != series) continue;
      const Range bar = error_bar(chart, point);
      text += fmt::format("{} {:.4f} {} {} \"#{}\"\n", *point.number.value, position(chart, point.row, series), bar.low,
                          bar.high, k);
    }
    text += "EOD\n";
  }
  text += "$floor << EOD\n";
  for (const ChartPoint& point : chart.points) {
    if (point.number.floor && (!chart.logarithmic || *point.number.floor > 0)) {
      text += fmt::format("{} {:.4f}\n", *point.number.floor, position(chart, point.row, point.series));
    }
  }
  return text + "EOD\n";
}

std::string axes(const ChartContents& chart) {
  const Range range = axis_range(chart);
  std::string text = fmt::format("set xrange [{}:{}]\nset yrange [{}:0.5]\n", range.low, range.high,
                                 static_cast<double>(chart.rows.size()) + 0.5);
  text += "set border 1 lc rgb \"#8a8f98\" lw 1\nset tics scale 0.4 nomirror textcolor rgb \"black\"\n";
  text += "set grid xtics lt 1 lw 1 lc rgb \"#e3e5e8\"\nset xtics out offset 0,0.2\n";
  if (chart.logarithmic) text += "set logscale x\nset format x \"%g\"\n" + logarithmic_tics('x', range.low, range.high);
  text += fmt::format("set xlabel {} offset 0,0.2\n", gnuplot_quoted(axis_title(*chart.metric)));
  text += "set ytics scale 0 (";
  for (std::size_t row = 0; row < chart.rows.size(); ++row) {
    text += fmt::format("{}{} {}", row == 0 ? "" : ", ", gnuplot_quoted(chart.rows[row]), row + 1);
  }
  text += ")\n";
  for (std::size_t row = 1; row < chart.rows.size(); ++row) {
    text += fmt::format("set arrow from graph 0, first {0} to graph 1, first {0} nohead lw 1 lc rgb \"#e3e5e8\" back\n",
                        static_cast<double>(row) + 0.5);
  }
  if (range.low < 0) text += "set arrow from 0, graph 0 to 0, graph 1 nohead lw 1 lc rgb \"#8a8f98\" back\n";
  return text;
}

std::string labels(const ChartContents& chart, const Layout& layout) {
  std::string text;
  for (const ChartGap& gap : chart.gaps) {
    text +=
        fmt::format("set label {} at graph 0.01, first {:.4f} textcolor rgb \"{}\"\n", gnuplot_quoted("✕ " + gap.mark),
                    position(chart, gap.row, gap.series), series_color(gap.series));
  }
  for (const KeyItem& item : layout.key) {
    const bool is_floor = item.index == chart.series.size();
    text += key_label(item, is_floor ? "" : series_symbol(item.index, symbol_size), layout.height);
    if (!is_floor) continue;
    const double x = (item.x + 6.0) / chart_width;
    const double y = 1 - (16.0 + key_line_height * item.line) / layout.height;
    const double half = 6.0 / layout.height;
    text += fmt::format("set arrow from screen {0:.4f}, screen {1:.4f} to screen {0:.4f}, screen {2:.4f} nohead {3}\n",
                        x, y - half, y + half, floor_style);
  }
  return text;
}

std::string plot_command(const ChartContents& chart) {
  std::vector<std::string> parts;
  if (has_floor(chart)) {
    parts.push_back(fmt::format("$floor using 1:($2-0.11):(0):(0.22) with vectors nohead {} notitle", floor_style));
  }
  for (std::size_t series = 0; series < chart.series.size(); ++series) {
    if (std::ranges::none_of(chart.points, [&](const ChartPoint& point) { return point.series == series; })) continue;
    parts.push_back(fmt::format("$series{} using 1:2:3:4 with xerrorbars pt 0 lw 1.5 lc rgb \"{}\" notitle", series,
                                series_color(series)));
    parts.push_back(fmt::format("$series{} using 1:2:5 with labels hypertext point {} notitle", series,
                                series_symbol(series, symbol_size)));
  }
  // A plot of nothing still draws the axes and the labels of the gaps.
  if (parts.empty()) parts.emplace_back("NaN notitle");
  return fmt::format("plot {}\n", fmt::join(parts, ", \\\n     "));
}

}  // namespace

std::string chart_script(const ChartContents& chart, const std::string& name) {
  const Layout layout = lay_out(chart);
  std::string text = "set encoding utf8\nset errorbars small\nunset key\n";
  text += margins(layout.left, 20, axis_space, layout.top, layout.height);
  text += data_blocks(chart) + axes(chart) + labels(chart, layout);
  text += plot_to_files(name, layout.height, plot_command(chart));
  return text;
}

}  // namespace textonbench
