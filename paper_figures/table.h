// Table: one row a group of runs (method and options), one column a metric, averaged over exemplars.
//
// [[figures]] keys: `metrics`, a list of names (default: every metric that the runs measure); `labels`, a list of
// {run, label} that gives rows their names.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "paper_figures/figure_kind.h"
#include "paper_figures/groups.h"
#include "paper_figures/metric_choice.h"

namespace textonbench {

struct TableRow {
  RunGroup group;
  std::size_t exemplars = 0;         ///< how many the group was run on
  std::vector<Average> cells{};      ///< one a metric
  std::vector<std::string> notes{};  ///< runs of the group without a result, and why
};

struct TableContents {
  std::vector<const MetricEntry*> metrics;
  std::vector<TableRow> rows;
};
TableContents fill_table(const FigureInput& input);

void check_table(const FigureInput& input);
/// <stem>.csv (one line a row, numbers in full precision), <stem>_records.csv (one line a record) and <stem>.html (a
/// piece of a page: one <table>).
std::vector<std::filesystem::path> write_table(const FigureInput& input, const ResultsFolder& results,
                                               const std::filesystem::path& stem);
std::string table_html(const FigureInput& input, PictureStore& pictures, const std::filesystem::path& stem);

/// A CSV field, quoted where RFC 4180 asks for it.
std::string csv_field(const std::string& text);

}  // namespace textonbench
