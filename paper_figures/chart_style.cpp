#include "paper_figures/chart_style.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "paper_figures/gnuplot.h"
#include "paper_figures/metric_choice.h"
#include "paper_figures/number_format.h"

namespace textonbench {
namespace {

constexpr std::array<const char*, 6> colors{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"};
constexpr std::array<int, 6> shapes{7, 5, 9, 13, 11, 15};
constexpr double pdf_centimeters = 16;

/// Where colors come again, outlines and dashes tell the series apart.
bool is_second_round(std::size_t series) { return series / colors.size() % 2 == 1; }

}  // namespace

std::size_t count_characters(const std::string& text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

const char* series_color(std::size_t series) { return colors.at(series % colors.size()); }

std::string series_symbol(std::size_t series, double size) {
  // Each shape's number less one is its outline.
  const int shape = shapes.at(series % shapes.size()) - (is_second_round(series) ? 1 : 0);
  return fmt::format("pt {} ps {} lc rgb \"{}\"", shape, size, series_color(series));
}

std::string series_line(std::size_t series, double width) {
  return fmt::format("lw {} dt {} lc rgb \"{}\"", width, is_second_round(series) ? 2 : 1, series_color(series));
}

std::string axis_title(const MetricEntry& metric) {
  std::string text(metric.title);
  if (const std::string unit = unit_of(metric); !unit.empty()) text += fmt::format(" [{}]", unit);
  if (const std::string direction = direction_of(metric); !direction.empty()) text += fmt::format(" ({})", direction);
  return text;
}

std::string logarithmic_tics(char axis, double low, double high) {
  const int first = static_cast<int>(std::floor(std::log10(low)));
  const int last = static_cast<int>(std::ceil(std::log10(high)));
  std::vector<std::string> decades, steps;
  for (int e = first; e <= last; ++e) {
    const bool plain = e >= -3 && e <= 3;
    for (const int digit : {1, 2, 5}) {
      const std::string value = fmt::format("{}e{}", digit, e);
      const double number = std::stod(value);
      if (number < low || number > high) continue;
      steps.push_back(fmt::format("'{}' {}", plain ? format_exact(number) : value, value));
      if (digit > 1) continue;
      decades.push_back(fmt::format("'{}' {}", plain ? format_exact(number) : format_power_of_ten(e), value));
    }
  }
  return fmt::format("set {}tics ({})\n", axis, fmt::join(decades.size() < 3 ? steps : decades, ", "));
}

std::vector<KeyItem> lay_out_key(int left, const std::vector<std::string>& texts) {
  std::vector<KeyItem> key;
  int x = left, line = 0;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const int item = 40 + character_width * static_cast<int>(count_characters(texts[i]));
    if (x > left && x + item > chart_width) {
      x = left;
      ++line;
    }
    key.push_back({i, texts[i], x, line});
    x += item;
  }
  return key;
}

int key_height(const std::vector<KeyItem>& key) {
  return 20 + key_line_height * (key.empty() ? 1 : key.back().line + 1);
}

std::string key_label(const KeyItem& item, const std::string& symbol, int height) {
  const double x = (item.x + 6.0) / chart_width;
  const double y = 1 - (16.0 + key_line_height * item.line) / height;
  std::string text;
  if (!symbol.empty()) text = fmt::format("set label '' at screen {:.4f}, screen {:.4f} point {}\n", x, y, symbol);
  return text + fmt::format("set label {} at screen {:.4f}, screen {:.4f} textcolor rgb \"black\"\n",
                            gnuplot_quoted(item.text), x + 10.0 / chart_width, y);
}

std::string margins(int left, int right, int bottom, int top, int height) {
  const auto across = [](int pixels) { return static_cast<double>(pixels) / chart_width; };
  const auto up = [&](int pixels) { return static_cast<double>(pixels) / height; };
  return fmt::format(
      "set lmargin at screen {:.4f}\nset rmargin at screen {:.4f}\nset bmargin at screen {:.4f}\n"
      "set tmargin at screen {:.4f}\n",
      across(left), 1 - across(right), up(bottom), 1 - up(top));
}

std::string plot_to_files(const std::string& name, int height, const std::string& plot) {
  return fmt::format(
      "set terminal svg noenhanced size {},{} dynamic font \"DejaVu Sans,13\"\nset output {}\n{}"
      "set terminal pdfcairo noenhanced size {}cm,{:.2f}cm font \"DejaVu Sans,8.5\"\nset output {}\nreplot\n"
      "unset output\n",
      chart_width, height, gnuplot_quoted(name + ".svg"), plot, pdf_centimeters, pdf_centimeters * height / chart_width,
      gnuplot_quoted(name + ".pdf"));
}

}  // namespace textonbench
