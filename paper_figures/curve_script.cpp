#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "paper_figures/chart_style.h"
#include "paper_figures/curve.h"
#include "paper_figures/gnuplot.h"

namespace textonbench {
namespace {

constexpr int curve_left = 84;
constexpr int curve_bottom = 62;
constexpr int curve_height = 340;

/// The band as drawn: none where it is infinite, and cut above zero on a logarithmic axis.
Estimate drawn_band(Estimate e, bool logarithmic) {
  if (!std::isfinite(e.low) || !std::isfinite(e.high)) return {e.value, e.value, e.value};
  if (logarithmic) e.low = std::max(e.low, e.value / 10);
  return e;
}

struct CurveSpan {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  void include(double value) { low = std::min(low, value), high = std::max(high, value); }
  void widen(bool logarithmic) {
    if (low > high) {
      low = 0.1;
      high = 1;
    } else if (logarithmic) {
      low /= 1.2;
      high *= 1.2;
    } else {
      const double margin = high > low ? 0.05 * (high - low) : 1;
      low = low >= 0 ? std::max(0.0, low - margin) : low - margin;
      high += margin;
    }
  }
};

std::string curve_data(const CurveContents& curve) {
  std::string text;
  std::size_t note = 0;
  for (std::size_t i = 0; i < curve.lines.size(); ++i) {
    text += fmt::format("$line{} << EOD\n", i);
    for (const CurvePoint& point : curve.lines[i].points) {
      const Estimate y = drawn_band(point.y, curve.logarithmic_y);
      text += fmt::format("{} {} {} {} \"#{}\"\n", point.x, y.value, y.low, y.high, note++);
    }
    text += "EOD\n";
  }
  return text;
}

std::string curve_axes(const CurveContents& curve) {
  CurveSpan x, y;
  for (const CurveLine& line : curve.lines) {
    for (const CurvePoint& point : line.points) {
      const Estimate band = drawn_band(point.y, curve.logarithmic_y);
      x.include(point.x);
      y.include(band.low);
      y.include(band.high);
    }
  }
  x.widen(curve.logarithmic_x);
  y.widen(curve.logarithmic_y);
  std::string text = fmt::format("set xrange [{}:{}]\nset yrange [{}:{}]\n", x.low, x.high, y.low, y.high);
  text += "set border 3 lc rgb \"#8a8f98\" lw 1\nset tics scale 0.4 nomirror textcolor rgb \"black\"\n";
  text += "set grid lt 1 lw 1 lc rgb \"#e3e5e8\"\n";
  if (curve.logarithmic_x) text += "set logscale x\nset format x \"%g\"\n" + logarithmic_tics('x', x.low, x.high);
  if (curve.logarithmic_y) text += "set logscale y\nset format y \"%g\"\n" + logarithmic_tics('y', y.low, y.high);
  return text + fmt::format("set xlabel {} offset 0,0.2\nset ylabel {}\n", gnuplot_quoted(curve.parameter),
                            gnuplot_quoted(axis_title(*curve.metric)));
}

std::string curve_plot(const CurveContents& curve) {
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < curve.lines.size(); ++i) {
    const char* color = series_color(i);
    parts.push_back(fmt::format(
        "$line{} using 1:3:4 with filledcurves fc rgb \"{}\" fs transparent solid 0.15 noborder notitle", i, color));
    parts.push_back(fmt::format("$line{} using 1:2 with lines {} notitle", i, series_line(i, 1.5)));
    parts.push_back(
        fmt::format("$line{} using 1:2:5 with labels hypertext point {} notitle", i, series_symbol(i, 0.6)));
  }
  if (parts.empty()) parts.emplace_back("NaN notitle");
  return fmt::format("plot {}\n", fmt::join(parts, ", \\\n     "));
}

}  // namespace

std::string curve_script(const CurveContents& curve, const std::string& name) {
  std::vector<std::string> titles;
  titles.reserve(curve.lines.size());
  for (const CurveLine& line : curve.lines) titles.push_back(line.title);
  const std::vector<KeyItem> key = lay_out_key(curve_left, titles);
  const int top = key_height(key);
  const int height = top + curve_height + curve_bottom;
  std::string text = "set encoding utf8\nunset key\n";
  text += margins(curve_left, 20, curve_bottom, top, height) + curve_data(curve) + curve_axes(curve);
  for (const KeyItem& item : key) text += key_label(item, series_symbol(item.index, 0.75), height);
  return text + plot_to_files(name, height, curve_plot(curve));
}

}  // namespace textonbench
