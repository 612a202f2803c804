#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <memory>
#include <stdexcept>

#include "experiments/cli/command.h"
#include "experiments/cli/run_filter.h"
#include "experiments/cli/table.h"
#include "experiments/provenance.h"
#include "experiments/runner.h"

namespace textonbench::cli {
namespace {

struct RunCommandOptions {
  std::vector<std::string> configs;
  Profile profile = Profile::quick;
  int jobs = 1;
  std::string filter;
  bool dry_run = false, fresh = false, yes_large = false, json = false;
};

/// The plans of all configs as one, each run once.
Plan joint_plan(const RunCommandOptions& options, const std::filesystem::path& home, const ExemplarCatalog& exemplars) {
  constexpr std::size_t usual_limit = 20000;
  const std::size_t limit = options.yes_large ? std::numeric_limits<std::size_t>::max() : usual_limit;
  Plan joint;
  std::map<std::string, std::size_t> index_of;  // by id
  for (const std::string& name : options.configs) {
    const Plan plan = make_plan(read_config(find_config(home, name), options.profile), exemplars, limit);
    for (const PlannedRun& run : plan.runs) {
      if (index_of.emplace(run.id, joint.runs.size()).second) joint.runs.push_back(run);
    }
    for (const auto& [label, indices] : plan.by_label) {
      for (const std::size_t i : indices) joint.by_label[label].push_back(index_of.at(plan.runs[i].id));
    }
    joint.missing.insert(joint.missing.end(), plan.missing.begin(), plan.missing.end());
  }
  return joint;
}

int show_plan(const Plan& plan, bool json) {
  if (json) {
    nlohmann::ordered_json runs = nlohmann::ordered_json::array(), missing = nlohmann::ordered_json::array();
    for (const PlannedRun& run : plan.runs) {
      runs.push_back({{"id", run.id}, {"label", run.label}, {"command", command_line(run.spec)}});
    }
    for (const MissingExemplar& exemplar : plan.missing) {
      missing.push_back({{"name", exemplar.name}, {"how_to_get", exemplar.how_to_get}, {"runs", exemplar.runs}});
    }
    print_json({{"planned", plan.runs.size()}, {"missing", missing}, {"runs", runs}});
    return 0;
  }
  std::map<std::pair<std::string, std::string>, int> counts;
  for (const PlannedRun& run : plan.runs) ++counts[{run.spec.method, run.spec.exemplar}];
  std::vector<std::vector<std::string>> rows;
  rows.reserve(counts.size());
  for (const auto& [key, count] : counts) rows.push_back({key.first, key.second, std::to_string(count)});
  print_table({{"METHOD"}, {"EXEMPLAR"}, {"RUNS", Align::right}}, rows);
  fmt::print("{} runs planned, none executed (--dry-run)\n", plan.runs.size());
  return 0;
}

int run(const RunCommandOptions& options, const GlobalOptions& globals) {
  const std::filesystem::path home = home_folder();
  const ExemplarCatalog exemplars(home);
  Plan plan = joint_plan(options, home, exemplars);
  if (!globals.quiet) tell_missing(plan);
  if (plan.runs.empty()) {
    throw std::invalid_argument("nothing to run: no exemplar of this config is here (textonbench list exemplars)");
  }
  if (!options.filter.empty())
    plan = {.runs = filter_runs(plan, options.filter), .missing = plan.missing, .by_label = {}};
  if (options.dry_run) return show_plan(plan, options.json);

  const ResultsFolder results(globals.results);
  const RunOptions how{.jobs = options.jobs,
                       .threads = std::max(1, thread_count(globals) / options.jobs),
                       .fresh = options.fresh,
                       .show_progress = !globals.quiet};
  bool interrupted = false;
  const RunSummary summary = run_plan(plan, exemplars, results, how, &interrupted);
  for (const BadLine& bad : summary.bad_lines) {
    fmt::print(stderr, "textonbench: warning: {}:{}: skipped: {}\n", (globals.results / "records.jsonl").string(),
               bad.line, bad.reason);
  }
  if (options.json) {
    print_json({{"planned", summary.planned},
                {"recorded", summary.recorded},
                {"reused", summary.reused},
                {"failed", summary.failed},
                {"refused", summary.refused},
                {"seconds", summary.seconds}});
  } else {
    fmt::print("{} runs: {} recorded, {} reused, {} refused, {} failed in {:.1f} s ({})\n", summary.planned,
               summary.recorded, summary.reused, summary.refused, summary.failed, summary.seconds,
               (globals.results / "records.jsonl").string());
  }
  if (interrupted) {
    fmt::print(stderr, "stopped: what is recorded is kept; the same command goes on from there\n");
    return 1;
  }
  if (!globals.quiet && !options.json) fmt::print(stderr, "next: textonbench report\n");
  return summary.failed > 0 ? 1 : 0;
}

}  // namespace

Command run_command(CLI::App& app, const GlobalOptions& globals) {
  const auto options = std::make_shared<RunCommandOptions>();
  CLI::App* command = app.add_subcommand("run", "Run experiment configs; what is recorded already is reused");
  command->add_option("CONFIG", options->configs, "Names (textonbench list configs) or files")->required();
  add_profile_option(*command, &options->profile);
  command->add_option("--jobs", options->jobs, "Runs at once, which share --threads (timings are truest with 1)")
      ->capture_default_str()
      ->check(CLI::Range(1, 1024));
  command->add_option("--filter", options->filter,
                      "Only runs with key=pattern,..., such as method=rpn,exemplar=mamurk*");
  command->add_flag("--dry-run", options->dry_run, "Show the plan and execute nothing");
  command->add_flag("--fresh", options->fresh, "Run again what is recorded already");
  command->add_flag("--yes-large", options->yes_large, "Accept a sweep of more than 20000 runs");
  command->add_flag("--json", options->json, "Print one JSON document");
  set_examples(*command,
               "  textonbench run lectures2022/rpn_adsn --dry-run\n"
               "  textonbench run my.toml --profile full --jobs 2 --filter method=adsn,seed=1");
  return {command, [options, &globals] { return run(*options, globals); }};
}

}  // namespace textonbench::cli
