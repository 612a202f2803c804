#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "paper_figures/chart_style.h"
#include "paper_figures/front.h"
#include "paper_figures/gnuplot.h"

namespace textonbench {
namespace {

constexpr int left_margin = 84;
constexpr int bottom_margin = 62;
constexpr int plot_height = 340;

struct Span {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  void include(double value) { low = std::min(low, value), high = std::max(high, value); }
};

/// Everything drawn, with room around it: a factor on a logarithmic axis, a share of the span on a linear one.
Span axis_span(Span data, bool logarithmic) {
  if (data.low > data.high) return {0.1, 1};
  if (logarithmic) return {data.low / 1.3, data.high * 1.3};
  const double margin = data.high > data.low ? 0.06 * (data.high - data.low) : 1;
  return {data.low >= 0 ? std::max(0.0, data.low - margin) : data.low - margin, data.high + margin};
}

/// The interval as drawn: none where it is infinite, and cut above zero where the axis has no place for less.
Estimate drawn(Estimate e, bool logarithmic) {
  if (!std::isfinite(e.low) || !std::isfinite(e.high)) return {e.value, e.value, e.value};
  if (logarithmic) e.low = std::max(e.low, e.value / 10);
  return e;
}

std::string datablocks(const FrontContents& front) {
  std::string text;
  for (std::size_t series = 0; series < front.series.size(); ++series) {
    text += fmt::format("$mean{} << EOD\n", series);
    for (std::size_t k = 0; k < front.means.size(); ++k) {
      const FrontMean& m = front.means[k];
      if (m.series != series) continue;
      const Estimate cost = drawn(m.cost, true), quality = drawn(m.quality, front.logarithmic);
      text += fmt::format("{} {} {} {} {} {} \"#{}\"\n", cost.value, quality.value, cost.low, cost.high, quality.low,
                          quality.high, k);
    }
    text += fmt::format("EOD\n$points{} << EOD\n", series);
    for (std::size_t k = 0; k < front.points.size(); ++k) {
      const FrontPoint& point = front.points[k];
      if (point.series == series) {
        text += fmt::format("{} {} \"#{}\"\n", point.cost, point.quality, front.means.size() + k);
      }
    }
    text += "EOD\n";
  }
  std::vector<const FrontMean*> best;
  for (const FrontMean& mean : front.means) {
    if (mean.on_front) best.push_back(&mean);
  }
  std::ranges::sort(best, {}, [](const FrontMean* mean) { return mean->cost.value; });
  text += "$front << EOD\n";
  for (const FrontMean* mean : best) text += fmt::format("{} {}\n", mean->cost.value, mean->quality.value);
  return text + "EOD\n";
}

std::string front_axes(const FrontContents& front) {
  Span costs, qualities;
  for (const FrontPoint& point : front.points) {
    costs.include(point.cost);
    qualities.include(point.quality);
  }
  for (const FrontMean& mean : front.means) {
    const Estimate cost = drawn(mean.cost, true), quality = drawn(mean.quality, front.logarithmic);
    costs.include(cost.low);
    costs.include(cost.high);
    qualities.include(quality.low);
    qualities.include(quality.high);
  }
  const Span x = axis_span(costs, true), y = axis_span(qualities, front.logarithmic);
  std::string text = fmt::format("set xrange [{}:{}]\nset yrange [{}:{}]\n", x.low, x.high, y.low, y.high);
  text += "set border 3 lc rgb \"#8a8f98\" lw 1\nset tics scale 0.4 nomirror textcolor rgb \"black\"\n";
  text += "set grid lt 1 lw 1 lc rgb \"#e3e5e8\"\nset logscale x\nset format x \"%g\"\n";
  text += logarithmic_tics('x', x.low, x.high);
  if (front.logarithmic) text += "set logscale y\nset format y \"%g\"\n" + logarithmic_tics('y', y.low, y.high);
  return text + fmt::format("set xlabel {} offset 0,0.2\nset ylabel {}\n", gnuplot_quoted(axis_title(*front.cost)),
                            gnuplot_quoted(axis_title(*front.quality)));
}

std::string front_plot(const FrontContents& front) {
  std::vector<std::string> parts;
  const auto any = [](const auto& list, std::size_t series) {
    return std::ranges::any_of(list, [&](const auto& item) { return item.series == series; });
  };
  if (!front.means.empty()) parts.emplace_back("$front using 1:2 with steps lw 2 lc rgb \"#a9aeb6\" notitle");
  for (std::size_t series = 0; series < front.series.size(); ++series) {
    if (!any(front.points, series)) continue;
    parts.push_back(fmt::format("$points{} using 1:2:3 with labels hypertext point {} notitle", series,
                                series_symbol(series, 0.4)));
    parts.push_back(fmt::format("$mean{} using 1:2:3:4:5:6 with xyerrorbars pt 0 lw 1.5 lc rgb \"{}\" notitle", series,
                                series_color(series)));
    parts.push_back(
        fmt::format("$mean{} using 1:2:7 with labels hypertext point {} notitle", series, series_symbol(series, 1.2)));
  }
  if (parts.empty()) parts.emplace_back("NaN notitle");
  return fmt::format("plot {}\n", fmt::join(parts, ", \\\n     "));
}

}  // namespace

std::string front_script(const FrontContents& front, const std::string& name) {
  const std::vector<KeyItem> key = lay_out_key(left_margin, front.series);
  const int top = key_height(key);
  const int height = top + plot_height + bottom_margin;
  std::string text = "set encoding utf8\nset errorbars small\nunset key\n";
  text += margins(left_margin, 20, bottom_margin, top, height) + datablocks(front) + front_axes(front);
  for (const KeyItem& item : key) text += key_label(item, series_symbol(item.index, 0.75), height);
  return text + plot_to_files(name, height, front_plot(front));
}

}  // namespace textonbench
