// Figures and tables of a config, made from records alone: the same records give the same bytes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "experiments/config.h"
#include "experiments/plan.h"
#include "experiments/record.h"

namespace textonbench {

/// What became of one [[figures]] table.
struct FigureOutcome {
  std::string name;
  std::string kind;
  std::vector<std::filesystem::path> files;  ///< written, relative to the results folder; none when refused
  std::string refused;                       ///< why it was not made, with the command that helps; empty when it was
};

struct FigureSummary {
  std::vector<FigureOutcome> figures;  ///< in config order

  std::size_t made() const;
  std::size_t refused() const { return figures.size() - made(); }
};

/// figures/<config>, relative to the results folder.
std::filesystem::path figures_folder(const Config& config);

/// Writes figures/<config>/<name>.* below the results folder, one figure for each [[figures]] table. A figure is
/// refused, the others being made all the same, when records of its runs are missing or come from different code
/// versions; files of an earlier time are then removed. Throws ConfigError for a figure table that cannot be
/// understood (before anything is written), std::runtime_error for a file that cannot be written, and when a chart is
/// asked for and gnuplot is not installed.
FigureSummary make_figures(const Config& config, const Plan& plan, const ResultsFolder& results);

}  // namespace textonbench
