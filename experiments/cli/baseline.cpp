#include "experiments/baseline.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <memory>

#include "experiments/cli/command.h"
#include "experiments/ledger.h"
#include "experiments/provenance.h"

namespace textonbench::cli {
namespace {

struct BaselineArguments {
  std::string reason;
  bool json = false;
};

int update(const BaselineArguments& arguments, const GlobalOptions& globals) {
  const std::filesystem::path folder = globals.results / "baseline";
  const ResultSet results = read_result_set(globals.results);
  // Whatever may be wrong with the claims shows before anything is replaced.
  const std::filesystem::path home = home_folder();
  const Ledger ledger = read_ledger(home, ExemplarCatalog(home), Profile::quick);
  const std::vector<ClaimOutcome> outcomes =
      evaluate_claims(ledger.claims, ledger.plans, ResultsFolder(globals.results).read().records);
  const auto now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  const BaselineUpdate done =
      update_baseline(results, folder, arguments.reason, fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now)));
  if (done.failed > 0) fmt::print(stderr, "{} failed runs left out\n", done.failed);
  if (done.other_code > 0) fmt::print(stderr, "{} runs of other code versions left out\n", done.other_code);
  write_verdicts(verdicts_file(globals.results), verdicts_of(outcomes));
  if (arguments.json) {
    print_json(done.history_line);
  } else {
    fmt::print("{}: {} runs and {} verdicts on claims; a line added to history.jsonl\n", folder.string(), done.runs,
               outcomes.size());
  }
  return 0;
}

}  // namespace

Command baseline_command(CLI::App& app, const GlobalOptions& globals) {
  const auto arguments = std::make_shared<BaselineArguments>();
  CLI::App* command = app.add_subcommand("baseline", "Keep results that later ones are held against");
  command->require_subcommand(1);
  CLI::App* update_app = command->add_subcommand("update", "Replace results/baseline by the records of the results");
  update_app->add_option("--reason", arguments->reason, "Why the numbers may change; kept in history.jsonl")
      ->required();
  update_app->add_flag("--json", arguments->json, "Print the line added to history.jsonl");
  for (CLI::App* shown : {command, update_app}) {
    set_examples(
        *shown,
        "  textonbench run && textonbench baseline update --reason \"order-3 splines are exact now\"\n"
        "  textonbench compare        # the baseline with the results folder\n"
        "Commit the folder results/baseline: records without pictures, and one line of history an update. Only\n"
        "runs of the latest record's code version are kept.");
  }
  return {command, [arguments, &globals] { return update(*arguments, globals); }};
}

}  // namespace textonbench::cli
