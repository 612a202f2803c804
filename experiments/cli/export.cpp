#include "paper_figures/export.h"

#include <fmt/format.h>

#include <memory>
#include <stdexcept>

#include "experiments/cli/command.h"
#include "experiments/cli/export_glsl.h"

namespace textonbench::cli {
namespace {

struct ExportArguments {
  std::filesystem::path csv, sqlite;
};

int write_export(const ExportArguments& arguments, const GlobalOptions& globals) {
  if (arguments.csv.empty() && arguments.sqlite.empty()) {
    throw std::invalid_argument(
        "nothing to write: expected --csv FOLDER, --sqlite FILE or both, or glsl METHOD EXEMPLAR");
  }
  const ReadRecords read = ResultsFolder(globals.results).read();
  for (const BadLine& bad : read.bad_lines) {
    fmt::print(stderr, "{}:{}: left out: {}\n", (globals.results / "records.jsonl").string(), bad.line, bad.reason);
  }
  if (read.records.empty()) {
    throw std::invalid_argument(fmt::format("{}: no record to export", globals.results.string()));
  }
  const std::vector<ExportTable> tables = make_export_tables(read.records);
  if (!arguments.csv.empty()) {
    for (const std::filesystem::path& file : write_csv(tables, arguments.csv)) fmt::print("{}\n", file.string());
  }
  if (!arguments.sqlite.empty()) {
    write_sqlite(tables, arguments.sqlite);
    fmt::print("{}\n", arguments.sqlite.string());
  }
  return 0;
}

}  // namespace

Command export_command(CLI::App& app, const GlobalOptions& globals) {
  const auto arguments = std::make_shared<ExportArguments>();
  CLI::App* command = app.add_subcommand(
      "export", "Write all records as CSV tables or as one SQLite file, or a noise for other engines");
  command->add_option("--csv", arguments->csv, "Folder for runs.csv, metrics.csv, params.csv, pictures.csv, …");
  command->add_option("--sqlite", arguments->sqlite,
                      "File with the tables runs, metrics, params, pictures, provenance");
  set_examples(*command,
               "  textonbench export --csv tables --sqlite results.sqlite\n"
               "  textonbench export glsl texton_noise HR_Cork -o cork\n\n"
               "Means over all runs, a line a method and metric:\n"
               "  sqlite3 results.sqlite \"SELECT method, name, avg(value) FROM metrics JOIN runs ON run = id\n"
               "    WHERE status = 'ok' GROUP BY method, name\"\n"
               "Worst exemplars of RPN of the periodic component:\n"
               "  sqlite3 results.sqlite \"SELECT exemplar, max(m.value) AS worst FROM runs\n"
               "    JOIN metrics m ON m.run = id AND m.name = 'patch_distance'\n"
               "    JOIN params p ON p.run = id AND p.name = 'component' AND p.value = 'periodic'\n"
               "    WHERE method = 'rpn' GROUP BY exemplar ORDER BY worst DESC LIMIT 5\"");
  const Command glsl = export_glsl_command(*command, globals);
  return {command, [arguments, glsl, &globals] {
            return glsl.app->parsed() ? glsl.action() : write_export(*arguments, globals);
          }};
}

}  // namespace textonbench::cli
