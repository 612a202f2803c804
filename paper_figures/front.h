// Quality against cost: a small point for each exemplar, a large one with 95 % intervals for the mean over exemplars,
// and the Pareto front of the means: the groups that no other beats in both.
//
// [[figures]] keys: `cost` and `quality`, names of metrics; `scale` of the quality, "linear" (default) or "log" (the
// cost is always on a logarithmic axis); `labels`, a list of {run, label} that gives groups their names.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/statistics/bootstrap.h"
#include "paper_figures/figure_kind.h"
#include "paper_figures/groups.h"
#include "paper_figures/metric_choice.h"

namespace textonbench {

struct FrontPoint {
  std::size_t series = 0;  ///< index of the group
  double cost = 0, quality = 0;
  std::string record{};  ///< id of the first record that went in
  std::string hover{};
};

/// Mean over exemplars of one group, with its two-level bootstrap interval over exemplars and seeds.
struct FrontMean {
  std::size_t series = 0;
  std::size_t exemplars = 0;
  Estimate cost, quality;
  bool on_front = false;
};

struct FrontContents {
  const MetricEntry* cost = nullptr;
  const MetricEntry* quality = nullptr;
  bool logarithmic = false;
  std::vector<std::string> series;
  std::vector<FrontPoint> points;  ///< one an exemplar of a group
  std::vector<FrontMean> means;    ///< of groups with a value, in order
  std::vector<std::string> gaps;   ///< groups without a value, each with the reason
};
FrontContents fill_front(const FigureInput& input);

void check_front(const FigureInput& input);
/// <stem>.svg, <stem>.pdf and <stem>.gp.
std::vector<std::filesystem::path> write_front(const FigureInput& input, const ResultsFolder& results,
                                               const std::filesystem::path& stem);
std::string front_html(const FigureInput& input, PictureStore& pictures, const std::filesystem::path& stem);

/// gnuplot script; mean k carries the hypertext "#k" and point k "#(means + k)".
std::string front_script(const FrontContents& front, const std::string& name);

}  // namespace textonbench
