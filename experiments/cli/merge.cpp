#include "experiments/merge.h"

#include <fmt/format.h>

#include <memory>

#include "experiments/cli/command.h"

namespace textonbench::cli {
namespace {

struct MergeCommandOptions {
  std::vector<std::filesystem::path> sources;
  bool json = false;
};

int merge(const MergeCommandOptions& options, const GlobalOptions& globals) {
  const ResultsFolder results(globals.results);
  nlohmann::ordered_json merged = nlohmann::ordered_json::array();
  for (const std::filesystem::path& source : options.sources) {
    const MergeSummary summary = merge_records(source, results);
    for (const BadLine& bad : summary.bad_lines) {
      fmt::print(stderr, "textonbench: warning: {}:{}: skipped: {}\n", summary.file.string(), bad.line, bad.reason);
    }
    if (options.json) {
      merged.push_back({{"file", summary.file.string()},
                        {"added", summary.added},
                        {"present", summary.present},
                        {"skipped_lines", summary.bad_lines.size()},
                        {"pictures", {{"copied", summary.pictures_copied}, {"missing", summary.pictures_missing}}}});
    } else {
      fmt::print("{}: {} records added, {} here already; {} pictures copied, {} missing\n", summary.file.string(),
                 summary.added, summary.present, summary.pictures_copied, summary.pictures_missing);
    }
  }
  if (options.json) print_json({{"merged", merged}});
  return 0;
}

}  // namespace

Command merge_command(CLI::App& app, const GlobalOptions& globals) {
  const auto options = std::make_shared<MergeCommandOptions>();
  CLI::App* command = app.add_subcommand("merge", "Add the records of other results folders to those here");
  command->add_option("RECORDS", options->sources, "Records files, or results folders with their pictures")->required();
  command->add_flag("--json", options->json, "Print one JSON document");
  set_examples(*command, "  textonbench merge /mnt/other_machine/results another/records.jsonl");
  return {command, [options, &globals] { return merge(*options, globals); }};
}

}  // namespace textonbench::cli
