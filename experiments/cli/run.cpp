#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>

#include "experiments/cli/command.h"
#include "experiments/cli/run_filter.h"
#include "experiments/cli/table.h"
#include "experiments/history.h"
#include "experiments/progress.h"
#include "experiments/provenance.h"
#include "experiments/runner.h"
#include "paper_figures/frame_table.h"

namespace textonbench::cli {
namespace {

struct RunCommandOptions {
  std::vector<std::string> configs;
  Profile profile = Profile::quick;
  int jobs = 1;
  std::string filter;
  bool dry_run = false, explain = false, fresh = false, yes_large = false, json = false;
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

/// The earlier records, without making the folder.
History read_history(const std::filesystem::path& results) {
  return History(std::filesystem::exists(results / "records.jsonl") ? ResultsFolder(results).read().records
                                                                    : std::vector<Record>{});
}

/// Time of the runs that would be made.
class TimeEstimate {
 public:
  TimeEstimate(const Plan& plan, const History& history, const ExemplarCatalog& exemplars, bool fresh) {
    std::map<std::string, Extent> sizes;
    for (const PlannedRun& run : plan.runs) {
      if (!fresh && history.is_reusable(run.id)) {
        ++reused_;
        continue;
      }
      const auto [size, is_new] = sizes.try_emplace(run.spec.exemplar);
      if (is_new && run.spec.size.area() == 0) {
        const std::optional<Extent> known = history.exemplar_size(run.spec.exemplar_sha256);
        size->second = known ? *known : load_exemplar(exemplars.find(run.spec.exemplar)).pixels.extent();
      }
      if (const auto seconds = history.estimate_seconds(run.spec, size->second)) {
        seconds_ += *seconds;
      } else {
        ++unknown_;
        methods_.insert(run.spec.method);
      }
    }
  }

  double seconds(int jobs) const { return seconds_ / jobs; }
  std::size_t reused() const { return reused_; }
  std::size_t unknown() const { return unknown_; }

  std::string text(const Plan& plan, int jobs) const {
    const std::size_t estimated = plan.runs.size() - reused_ - unknown_;
    std::string text = fmt::format("{} reused", reused_);
    if (estimated > 0) {
      text += fmt::format("; {} in about {} with --jobs {}", estimated, readable_duration(std::max(1.0, seconds(jobs))),
                          jobs);
    }
    if (unknown_ > 0) {
      text += fmt::format("; the time of {} is unknown: no record of {} yet", unknown_, fmt::join(methods_, ", "));
    }
    return text;
  }

 private:
  double seconds_ = 0;
  std::size_t reused_ = 0, unknown_ = 0;
  std::set<std::string> methods_;
};

/// --explain: what would happen to each run, and why.
int explain_plan(const Plan& plan, const RunCommandOptions& options, const History& history) {
  nlohmann::ordered_json runs = nlohmann::ordered_json::array();
  std::size_t reused = 0;
  for (const PlannedRun& run : plan.runs) {
    const bool recorded = history.is_reusable(run.id);
    const bool reuse = recorded && !options.fresh;
    const std::string reason = reuse ? "recorded" : recorded ? "asked for by --fresh" : history.why_run(run);
    reused += reuse ? 1 : 0;
    if (options.json) {
      runs.push_back({{"id", run.id},
                      {"action", reuse ? "reuse" : "run"},
                      {"reason", reason},
                      {"command", command_line(run.spec)}});
    } else {
      fmt::print("{} {}\n    {}\n", reuse ? "reuse" : "run  ", command_line(run.spec), reason);
    }
  }
  if (options.json) {
    print_json({{"planned", plan.runs.size()}, {"reused", reused}, {"runs", runs}});
  } else {
    fmt::print("{} run{} planned, {} to reuse, {} to run; none executed (--explain)\n", plan.runs.size(),
               plan.runs.size() == 1 ? "" : "s", reused, plan.runs.size() - reused);
  }
  return 0;
}

int show_plan(const Plan& plan, const RunCommandOptions& options, const TimeEstimate& estimate) {
  if (options.json) {
    nlohmann::ordered_json runs = nlohmann::ordered_json::array(), missing = nlohmann::ordered_json::array();
    for (const PlannedRun& run : plan.runs) {
      runs.push_back({{"id", run.id}, {"label", run.label}, {"command", command_line(run.spec)}});
    }
    for (const MissingExemplar& exemplar : plan.missing) {
      missing.push_back({{"name", exemplar.name}, {"how_to_get", exemplar.how_to_get}, {"runs", exemplar.runs}});
    }
    print_json({{"planned", plan.runs.size()},
                {"reused", estimate.reused()},
                {"estimated_seconds", estimate.seconds(options.jobs)},
                {"unknown", estimate.unknown()},
                {"missing", missing},
                {"runs", runs}});
    return 0;
  }
  std::map<std::pair<std::string, std::string>, int> counts;
  for (const PlannedRun& run : plan.runs) ++counts[{run.spec.method, run.spec.exemplar}];
  std::vector<std::vector<std::string>> rows;
  rows.reserve(counts.size());
  for (const auto& [key, count] : counts) rows.push_back({key.first, key.second, std::to_string(count)});
  print_table({{"METHOD"}, {"EXEMPLAR"}, {"RUNS", Align::right}}, rows);
  fmt::print("{} run{} planned, none executed (--dry-run); {}\n", plan.runs.size(), plan.runs.size() == 1 ? "" : "s",
             estimate.text(plan, options.jobs));
  return 0;
}

/// A table of frame times, which is printed once its runs have ended, with the plan of its config.
struct AwaitedTable {
  FigureTable figure;
  Plan plan;
};

/// Throws ConfigError for a table that cannot be printed: hours of runs are to end in one.
std::vector<AwaitedTable> frame_tables(const RunCommandOptions& options, const std::filesystem::path& home,
                                       const ExemplarCatalog& exemplars) {
  std::vector<AwaitedTable> tables;
  for (const std::string& name : options.configs) {
    const Config config = read_config(find_config(home, name), options.profile);
    for (const FigureTable& figure : config.figures) {
      if (figure.kind != "frame_table") continue;
      Plan plan = make_plan(config, exemplars, std::numeric_limits<std::size_t>::max());
      check_frame_table({figure, select_runs(figure, plan, {}), ""});
      tables.push_back({figure, std::move(plan)});
    }
  }
  return tables;
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
  if (options.explain) return explain_plan(plan, options, read_history(globals.results));
  if (options.dry_run) {
    return show_plan(plan, options, TimeEstimate(plan, read_history(globals.results), exemplars, options.fresh));
  }

  const std::vector<AwaitedTable> tables = frame_tables(options, home, exemplars);
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
  if (!options.json && !tables.empty()) {
    const std::vector<Record> records = results.read().records;
    for (const AwaitedTable& table : tables) {
      fmt::print("\n{}", frame_table_text({table.figure, select_runs(table.figure, table.plan, records), ""}));
    }
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
  command->add_flag("--dry-run", options->dry_run, "Show the plan with an estimate of its time; execute nothing");
  command->add_flag("--explain", options->explain, "Say of each run why it would be reused or made; execute nothing");
  command->add_flag("--fresh", options->fresh, "Run again what is recorded already");
  command->add_flag("--yes-large", options->yes_large, "Accept a sweep of more than 20000 runs");
  command->add_flag("--json", options->json, "Print one JSON document");
  set_examples(*command,
               "  textonbench run lectures2022/rpn_adsn --dry-run\n"
               "  textonbench run my.toml --profile full --jobs 2 --filter method=adsn,seed=1");
  return {command, [options, &globals] { return run(*options, globals); }};
}

}  // namespace textonbench::cli
