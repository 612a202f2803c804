// Dot chart of one metric: a row an exemplar, a series a group of runs, with error bars and the noise floor.
//
// [[figures]] keys: `metric`, its name; `scale`, "linear" (default) or "log"; `labels`, a list of {run, label} that
// gives series their names.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "paper_figures/figure_kind.h"
#include "paper_figures/groups.h"
#include "paper_figures/metric_choice.h"

namespace textonbench {

struct ChartPoint {
  std::size_t row = 0;     ///< index of the exemplar
  std::size_t series = 0;  ///< index of the group
  Average number;          ///< over seeds
  std::string record{};    ///< id of the first record that went in
  std::string hover{};     ///< "rpn on ring: 0.432 ± 0.002"
};

/// A group that was planned on an exemplar and has no value to draw there.
struct ChartGap {
  std::size_t row = 0;
  std::size_t series = 0;
  std::string mark;    ///< in a word or two, for the chart
  std::string reason;  ///< in full, for the text below
};

struct ChartContents {
  const MetricEntry* metric = nullptr;
  bool logarithmic = false;
  std::vector<std::string> rows;    ///< exemplars
  std::vector<std::string> series;  ///< titles of groups
  std::vector<ChartPoint> points;
  std::vector<ChartGap> gaps;
};
ChartContents fill_chart(const FigureInput& input);

void check_chart(const FigureInput& input);
/// <stem>.svg, <stem>.pdf and <stem>.gp, the gnuplot script that both come from. Throws std::runtime_error when gnuplot
/// is not installed.
std::vector<std::filesystem::path> write_chart(const FigureInput& input, const ResultsFolder& results,
                                               const std::filesystem::path& stem);
std::string chart_html(const FigureInput& input, PictureStore& pictures, const std::filesystem::path& stem);

}  // namespace textonbench
