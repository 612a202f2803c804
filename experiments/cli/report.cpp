#include "paper_figures/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "experiments/cli/command.h"
#include "experiments/ledger.h"
#include "experiments/provenance.h"
#include "paper_figures/ledger_page.h"

namespace textonbench::cli {
namespace {

struct ReportOptions {
  std::vector<std::string> configs;
  Profile profile = Profile::quick;
  bool json = false;
};

int write(const ReportOptions& options, const GlobalOptions& globals) {
  const std::filesystem::path home = home_folder();
  const ExemplarCatalog exemplars(home);
  const ResultsFolder results(globals.results);

  std::vector<ReportConfig> configs;
  for (const std::filesystem::path& file : chosen_configs(home, options.configs)) {
    Config config = read_config(file, options.profile);
    Plan plan = make_plan(config, exemplars);
    configs.push_back({.config = std::move(config), .plan = std::move(plan)});
  }
  std::stable_partition(configs.begin(), configs.end(),
                        [](const ReportConfig& config) { return !config.config.appendix; });
  const Ledger ledger = read_ledger(home, exemplars, options.profile);
  write_ledger_page(evaluate_claims(ledger.claims, ledger.plans, results.read().records), results);
  const std::filesystem::path page = std::filesystem::absolute(write_report(configs, exemplars, results));
  if (options.json) {
    print_json({{"report", page.string()}});
  } else {
    fmt::print("{}\n", page.string());
  }
  return 0;
}

}  // namespace

Command report_command(CLI::App& app, const GlobalOptions& globals) {
  const auto options = std::make_shared<ReportOptions>();
  CLI::App* command = app.add_subcommand("report", "Write the HTML report from recorded runs");
  command->add_option("CONFIG", options->configs, "Names (textonbench list configs) or files (all configs)");
  add_profile_option(*command, &options->profile);
  command->add_flag("--json", options->json, "Print one JSON document");
  set_examples(*command, "  textonbench report && xdg-open results/report/index.html");
  return {command, [options, &globals] { return write(*options, globals); }};
}

}  // namespace textonbench::cli
