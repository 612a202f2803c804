// A metric against a numeric parameter that the runs sweep: one line a group of runs, or one a group and exemplar.
//
// [[figures]] keys: `parameter`, the swept one; `metric`; `band`, what is drawn around the line: "interval" (default),
// the 95 % two-level bootstrap interval of the mean over exemplars and seeds, or "deviation", the standard deviation of
// the values; `each`, "mean" over exemplars (default) or "exemplar"; `scale_x` and `scale`, "linear" (default) or
// "log", of the two axes; `labels`, a list of {run, label} that gives groups their names.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/statistics/bootstrap.h"
#include "paper_figures/figure_kind.h"
#include "paper_figures/groups.h"
#include "paper_figures/metric_choice.h"

namespace textonbench {

struct CurvePoint {
  double x = 0;
  Estimate y;             ///< mean with its band; infinite where there is none
  std::size_t count = 0;  ///< values that went in
  std::string record;     ///< id of the first of their records
};

struct CurveLine {
  std::string title;
  std::vector<CurvePoint> points;  ///< by x
};

struct CurveContents {
  const MetricEntry* metric = nullptr;
  std::string parameter;
  bool is_deviation = false, logarithmic_x = false, logarithmic_y = false;
  std::vector<CurveLine> lines;   ///< those that have a point
  std::vector<std::string> gaps;  ///< what is not drawn, each with the reason
};
CurveContents fill_curve(const FigureInput& input);

void check_curve(const FigureInput& input);
/// <stem>.svg, <stem>.pdf and <stem>.gp.
std::vector<std::filesystem::path> write_curve(const FigureInput& input, const ResultsFolder& results,
                                               const std::filesystem::path& stem);
std::string curve_html(const FigureInput& input, PictureStore& pictures, const std::filesystem::path& stem);

/// gnuplot script; points carry the hypertext "#0", "#1", …, line after line.
std::string curve_script(const CurveContents& curve, const std::string& name);

}  // namespace textonbench
