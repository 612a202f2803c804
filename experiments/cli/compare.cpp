#include "experiments/compare.h"

#include <fmt/format.h>

#include <memory>
#include <stdexcept>

#include "experiments/cli/command.h"
#include "experiments/cli/table.h"

namespace textonbench::cli {
namespace {

struct CompareArguments {
  std::filesystem::path first, second;  ///< as given; empty when not
  bool baseline = false, json = false;
};

struct Sides {
  std::filesystem::path old_side, new_side;
};

Sides chosen_sides(const CompareArguments& arguments, const GlobalOptions& globals) {
  const std::filesystem::path& first = arguments.first;
  const std::filesystem::path& second = arguments.second;
  if (!second.empty()) {
    if (arguments.baseline) throw std::invalid_argument("--baseline is OLD: expected at most NEW besides");
    return {first, second};
  }
  if (!first.empty() && !arguments.baseline) {
    throw std::invalid_argument(
        fmt::format("{} with what? Expected OLD NEW, --baseline NEW, or neither (the baseline with the results folder)",
                    first.string()));
  }
  return {globals.results / "baseline", first.empty() ? globals.results : first};
}

std::vector<std::string> cells_of_row(const MetricComparison& row) {
  const std::string name = row.method.empty() ? row.metric : "  " + row.method;
  std::vector<std::string> cells{name, std::string(to_string(row.verdict))};
  if (row.pairs == 0) {
    cells.insert(cells.end(), {"", "", "", "", "", "", row.reason});
    return cells;
  }
  cells.push_back(fmt::format("{:.4g}", row.old_mean));
  cells.push_back(fmt::format("{:.4g}", row.new_mean));
  cells.push_back(change_text(row, row.change.value));
  cells.push_back(fmt::format("{} … {}", change_text(row, row.change.low), change_text(row, row.change.high)));
  cells.push_back(row.relative ? fmt::format("{:g} %", 100 * row.margin) : fmt::format("{:g}", row.margin));
  cells.push_back(fmt::format("{}", row.exemplars));
  cells.push_back(row.reason);
  return cells;
}

std::string counted(std::size_t regressions) {
  return fmt::format("{} regression{}", regressions, regressions == 1 ? "" : "s");
}

void print_comparison(const Comparison& comparison, const Sides& sides) {
  std::vector<std::vector<std::string>> rows;
  for (const MetricComparison& row : comparison.metrics) {
    if (row.pairs == 0 && row.verdict == Verdict::not_compared && row.reason == "no pair of runs has it") continue;
    rows.push_back(cells_of_row(row));
    for (const MetricComparison& method : row.methods) {
      if (method.verdict != row.verdict || row.verdict == Verdict::worse) rows.push_back(cells_of_row(method));
    }
  }
  print_table({{"METRIC"},
               {"VERDICT"},
               {"OLD", Align::right},
               {"NEW", Align::right},
               {"CHANGE", Align::right},
               {"95 % INTERVAL", Align::right},
               {"MARGIN", Align::right},
               {"EXEMPLARS", Align::right},
               {"REASON"}},
              rows);
  for (const std::string& run : comparison.newly_failed) fmt::print("newly failed: {}\n", run);
  fmt::print("{} runs of {} and {} compared, {} only in the first, {} only in the second; {}\n", comparison.pairs,
             sides.old_side.string(), sides.new_side.string(), comparison.only_old, comparison.only_new,
             counted(comparison.regressions()));
}

int run_comparison(const CompareArguments& arguments, const GlobalOptions& globals) {
  const Sides sides = chosen_sides(arguments, globals);
  const ResultSet old_set = read_result_set(sides.old_side);
  const ResultSet new_set = read_result_set(sides.new_side);
  for (const ResultSet* set : {&old_set, &new_set}) {
    for (const BadLine& bad : set->bad_lines) {
      fmt::print(stderr, "{}:{}: left out: {}\n", set->file.string(), bad.line, bad.reason);
    }
  }
  const Comparison comparison = compare(old_set, new_set);
  if (arguments.json) {
    print_json(to_json(comparison));
  } else {
    print_comparison(comparison, sides);
  }
  return comparison.regressions() > 0 ? 1 : 0;
}

}  // namespace

Command compare_command(CLI::App& app, const GlobalOptions& globals) {
  const auto arguments = std::make_shared<CompareArguments>();
  CLI::App* command = app.add_subcommand("compare", "Tell better, same, worse or inconclusive, metric by metric");
  command->add_option("OLD", arguments->first, "Results folder or records file (the folder baseline of the results)");
  command->add_option("NEW", arguments->second, "The same (the results folder)");
  command->add_flag("--baseline", arguments->baseline, "OLD is the baseline, and the argument is NEW");
  command->add_flag("--json", arguments->json, "Print one JSON document");
  set_examples(
      *command,
      "  textonbench --results before run lectures2022/rpn_adsn   # then change the code\n"
      "  textonbench --results after run lectures2022/rpn_adsn\n"
      "  textonbench compare before after\n"
      "Runs are paired by what they compute. The change is relative (or absolute, without %), its interval that\n"
      "of the two-level bootstrap over exemplars and runs; inside the margin it is the same. Tests\n"
      "share an error rate of 5 %. Exit status 1: something is worse.");
  return {command, [arguments, &globals] { return run_comparison(*arguments, globals); }};
}

}  // namespace textonbench::cli
