// What the gnuplot scripts of all charts share: colors, symbols, the key, the axes' titles, the terminals.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "experiments/metrics/metric.h"

namespace textonbench {

constexpr int chart_width = 760;     ///< SVG pixels
constexpr int key_line_height = 22;  ///< SVG pixels
/// Text is measured by its number of characters, so that a layout is the same everywhere.
constexpr int character_width = 8;

std::size_t count_characters(const std::string& text);

/// Okabe and Ito's palette, distinguishable by color-blind readers; shapes tell series apart in black and white.
const char* series_color(std::size_t series);
/// gnuplot's point style of a series: "pt 7 ps 0.75 lc rgb …".
std::string series_symbol(std::size_t series, double size);
/// Its line style: "lw 1.5 dt 1 lc rgb …".
std::string series_line(std::size_t series, double width);

/// "Relative model error (lower is better)".
std::string axis_title(const MetricEntry& metric);

/// `set xtics (…)` (or ytics) with one tick a decade, or three where there are fewer than three decades.
std::string logarithmic_tics(char axis, double low, double high);

/// An entry of the key above a chart, from `x` in SVG pixels on, in its line.
struct KeyItem {
  std::size_t index;
  std::string text;
  int x, line;
};
/// Entries one after the other from `left` on, in as many lines as they need.
std::vector<KeyItem> lay_out_key(int left, const std::vector<std::string>& texts);
/// Height of the key with its margins, SVG pixels.
int key_height(const std::vector<KeyItem>& key);
/// `set label` commands of one entry: `symbol` (from series_symbol) and its text.
std::string key_label(const KeyItem& item, const std::string& symbol, int height);

/// Margins in SVG pixels, as `set lmargin …` commands.
std::string margins(int left, int right, int bottom, int top, int height);

/// Writes <name>.svg and <name>.pdf by this plot command.
std::string plot_to_files(const std::string& name, int height, const std::string& plot);

}  // namespace textonbench
