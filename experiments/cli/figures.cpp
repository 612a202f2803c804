#include "paper_figures/figures.h"

#include <fmt/format.h>

#include <memory>

#include "experiments/cli/command.h"
#include "experiments/provenance.h"

namespace textonbench::cli {
namespace {

struct FiguresOptions {
  std::vector<std::string> configs;
  Profile profile = Profile::quick;
  bool json = false;
};

int make(const FiguresOptions& options, const GlobalOptions& globals) {
  const std::filesystem::path home = home_folder();
  const ExemplarCatalog exemplars(home);
  const ResultsFolder results(globals.results);

  nlohmann::ordered_json figures = nlohmann::ordered_json::array();
  std::size_t made = 0, refused = 0;
  for (const std::filesystem::path& file : chosen_configs(home, options.configs)) {
    const Config config = read_config(file, options.profile);
    const FigureSummary summary = make_figures(config, make_plan(config, exemplars), results);
    made += summary.made();
    refused += summary.refused();
    for (const FigureOutcome& figure : summary.figures) {
      nlohmann::ordered_json written = nlohmann::ordered_json::array();
      for (const std::filesystem::path& path : figure.files) {
        written.push_back((results.path() / path).string());
        if (!options.json) fmt::print("{}\n", (results.path() / path).string());
      }
      if (!figure.refused.empty()) {
        fmt::print(stderr, "{}: {}: not made: {}\n", config.name, figure.name, figure.refused);
      }
      figures.push_back({{"config", config.name},
                         {"name", figure.name},
                         {"kind", figure.kind},
                         {"files", written},
                         {"refused", figure.refused}});
    }
  }
  if (options.json) {
    print_json({{"figures", figures}, {"made", made}, {"refused", refused}});
  } else {
    fmt::print("{} figures made, {} not made\n", made, refused);
  }
  return refused > 0 ? 1 : 0;
}

}  // namespace

Command figures_command(CLI::App& app, const GlobalOptions& globals) {
  const auto options = std::make_shared<FiguresOptions>();
  CLI::App* command = app.add_subcommand("figures", "Make the figures of configs from recorded runs");
  command->add_option("CONFIG", options->configs, "Names (textonbench list configs) or files (all configs)");
  add_profile_option(*command, &options->profile);
  command->add_flag("--json", options->json, "Print one JSON document");
  set_examples(*command, "  textonbench figures lectures2022/rpn_adsn");
  return {command, [options, &globals] { return make(*options, globals); }};
}

}  // namespace textonbench::cli
