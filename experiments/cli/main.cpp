#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <stdexcept>
#include <vector>

#include "experiments/cli/command.h"
#include "experiments/provenance.h"

namespace {

using textonbench::cli::Command;
using textonbench::cli::GlobalOptions;

constexpr int unusable_input = 2;

std::string version_text() {
  const nlohmann::ordered_json p = textonbench::provenance();
  return fmt::format("textonbench {} (commit {}{})", p["version"].get<std::string>(),
                     p["git_commit"].get<std::string>(), p["git_dirty"] == true ? ", changed" : "");
}

int run(int argc, char** argv) {
  CLI::App app("Benchmark and reproducibility harness for Gaussian micro-texture synthesis", "textonbench");
  // At most: an unknown word is then told as such, and not as a missing subcommand.
  app.require_subcommand(0, 1);
  // Global options may also follow the subcommand.
  app.fallthrough();
  GlobalOptions globals;
  app.add_option("--threads", globals.threads, "Threads to use (as many as the machine has)")
      ->check(CLI::Range(1, 4096));
  app.add_option("--results", globals.results, "Results folder")->capture_default_str();
  app.add_flag("--quiet", globals.quiet, "No progress and no hints");
  app.set_version_flag("--version", version_text);
  app.footer(
      "Example:\n"
      "  textonbench synth adsn mamurk_a_1 -o sample.png && textonbench measure adsn mamurk_a_1\n"
      "Exit status: 0 done, 1 the answer is no (a run failed, a metric or a claim got worse), 2 unusable input. "
      "Configs "
      "are looked for\n"
      "in the folder that TEXTONBENCH_HOME names, exemplars also in the folder that TEXTONBENCH_DATA names.");
  app.failure_message([](const CLI::App* failed, const CLI::Error& error) {
    return fmt::format("textonbench: error: {}\n(see textonbench {}--help)\n", error.what(),
                       failed->get_subcommands().empty() ? "" : failed->get_subcommands().front()->get_name() + " ");
  });

  std::vector<Command> commands;
  for (const auto make :
       {textonbench::cli::list_command, textonbench::cli::fit_command, textonbench::cli::synth_command,
        textonbench::cli::inpaint_command, textonbench::cli::measure_command, textonbench::cli::run_command,
        textonbench::cli::merge_command, textonbench::cli::figures_command, textonbench::cli::report_command,
        textonbench::cli::claims_command, textonbench::cli::compare_command, textonbench::cli::baseline_command,
        textonbench::cli::export_command, textonbench::cli::fps_command}) {
    commands.push_back(make(app, globals));
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : unusable_input;
  }
  for (const Command& command : commands) {
    if (command.app->parsed()) return command.action();
  }
  throw std::invalid_argument("a subcommand is expected (see textonbench --help)");
}

}  // namespace

int main(int argc, char** argv) {
  // A file size limit then shows as a failed write, with its reason, instead of killing the program.
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    return run(argc, argv);
  } catch (const std::bad_alloc&) {
    fmt::print(
        stderr,
        "textonbench: error: this machine has not the memory: take a smaller --size, or fewer --threads or --jobs; "
        "synth writes a large window of the plane band by band to an .exr\n");
    return unusable_input;
  } catch (const std::exception& error) {
    fmt::print(stderr, "textonbench: error: {}\n", error.what());
    return unusable_input;
  }
}
