// Table of textons: how near each comes to the best that its support allows, and how many impacts its noise needs.
//
// A row is a texton: runs that differ in exemplar, seed, `impacts` and `mni` only. Below it stand its exemplars. A run
// that measures `rme_bound` has no row: it gives the bound to the textons of its exemplar and support (`support`,
// `shape`, `mask`). Columns are the metrics rme, kept_variance, kernel_kurtosis, poisson_impacts and
// stratified_impacts, and
//
//   gap           RME − bound,
//   gap_squared   RME² − bound²,
//   poisson_patch_impacts, stratified_patch_impacts
//                 the MNI from which on limit_patch_distance stays at or below twice its floor, by interpolation
//                 between the MNI of the runs (crossing.h). The floor is taken as it is, without an error of its own,
//                 and falls with the number of samples.
//
// The number of a row is the mean over its exemplars, geometric for kurtosis and impacts, with the least and the
// greatest of them; that of an exemplar has the 95 % interval of its samples where it is measured on samples.
//
// [[figures]] keys: `labels`, a list of {run, label} that gives rows their names.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/statistics/bootstrap.h"
#include "paper_figures/figure_kind.h"

namespace textonbench {

struct TextonColumn {
  std::string_view name, title;
  std::string_view arrow;  ///< "↓", "↑", or empty
};
std::vector<TextonColumn> texton_columns();

struct TextonCell {
  std::optional<Estimate> number;    ///< a closed form of one exemplar has an interval of no width
  std::size_t below = 0, above = 0;  ///< exemplars that need fewer or more impacts than any of the runs has
  double fewest = 0, most = 0;       ///< impacts of the runs
};

struct TextonLine {
  std::string exemplar;  ///< empty for the mean
  std::string record;    ///< id of the first of its runs
  std::vector<TextonCell> cells;
};

struct TextonRow {
  std::string title, detail;
  TextonLine mean;
  std::vector<TextonLine> exemplars;
  std::vector<std::string> notes;  ///< runs without a result, and why
};
std::vector<TextonRow> fill_texton_table(const FigureInput& input);

void check_texton_table(const FigureInput& input);
/// <stem>.csv (a line an exemplar, and one for the mean, of each row) and <stem>.html (one <table>).
std::vector<std::filesystem::path> write_texton_table(const FigureInput& input, const ResultsFolder& results,
                                                      const std::filesystem::path& stem);
std::string texton_table_html(const FigureInput& input, PictureStore& pictures, const std::filesystem::path& stem);

}  // namespace textonbench
