#include "paper_figures/figures.h"

#include <algorithm>

#include "experiments/files.h"
#include "paper_figures/anchors.h"
#include "paper_figures/figure_kind.h"
#include "paper_figures/selection.h"

namespace textonbench {
namespace {

/// Files that an earlier run made for this figure: none may be left when it is refused now.
void remove_figure(const std::filesystem::path& stem) {
  for (const char* suffix :
       {".png", ".inputs", ".svg", ".pdf", ".gp", ".csv", "_records.csv", "_ratios.csv", ".html"}) {
    std::filesystem::remove(with_suffix(stem, suffix));
  }
}

}  // namespace

std::size_t FigureSummary::made() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(figures, [](const FigureOutcome& figure) { return figure.refused.empty(); }));
}

FigureSummary make_figures(const Config& config, const Plan& plan, const ResultsFolder& results) {
  for (const FigureTable& table : config.figures) {
    find_figure_kind(table).check({table, select_runs(table, plan, {}), figure_anchor(config, table)});
  }
  const std::vector<Record> records = results.read().records;
  const std::filesystem::path folder = figures_folder(config);
  FigureSummary summary;
  for (const FigureTable& table : config.figures) {
    FigureOutcome outcome{table.name, table.kind, {}, ""};
    const std::filesystem::path stem = results.path() / folder / table.name;
    std::filesystem::create_directories(stem.parent_path());
    const std::vector<SelectedRun> runs = select_runs(table, plan, records);
    if (const auto problem = unusable(config, runs)) {
      remove_figure(stem);
      outcome.refused = *problem;
    } else {
      for (const auto& file :
           find_figure_kind(table).write({table, runs, figure_anchor(config, table)}, results, stem)) {
        outcome.files.push_back(folder / file.filename());
      }
    }
    summary.figures.push_back(std::move(outcome));
  }
  return summary;
}

std::filesystem::path figures_folder(const Config& config) { return std::filesystem::path("figures") / config.name; }

}  // namespace textonbench
