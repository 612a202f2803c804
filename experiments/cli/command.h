// What the subcommands share.
#pragma once

#include <tbb/global_control.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "experiments/config.h"
#include "experiments/exemplars.h"
#include "experiments/plan.h"
#include "methods/method.h"

namespace textonbench::cli {

/// Options that stand before or after any subcommand.
struct GlobalOptions {
  int threads = 0;  ///< 0: as many as the machine has
  std::filesystem::path results = "results";
  bool quiet = false;
};

/// A subcommand and what it does once its options are read: returns the exit status, throws for unusable input.
struct Command {
  CLI::App* app;
  std::function<int()> action;
};

Command list_command(CLI::App& app, const GlobalOptions& globals);
Command fit_command(CLI::App& app, const GlobalOptions& globals);
Command synth_command(CLI::App& app, const GlobalOptions& globals);
Command inpaint_command(CLI::App& app, const GlobalOptions& globals);
Command measure_command(CLI::App& app, const GlobalOptions& globals);
Command run_command(CLI::App& app, const GlobalOptions& globals);
Command merge_command(CLI::App& app, const GlobalOptions& globals);
Command figures_command(CLI::App& app, const GlobalOptions& globals);
Command report_command(CLI::App& app, const GlobalOptions& globals);
Command claims_command(CLI::App& app, const GlobalOptions& globals);
Command compare_command(CLI::App& app, const GlobalOptions& globals);
Command baseline_command(CLI::App& app, const GlobalOptions& globals);
Command export_command(CLI::App& app, const GlobalOptions& globals);
Command fps_command(CLI::App& app, const GlobalOptions& globals);

int thread_count(const GlobalOptions& globals);
/// Holds every parallel loop to the threads that were asked for, for as long as it lives.
tbb::global_control limit_threads(const GlobalOptions& globals);

/// What `--help` ends with.
void set_examples(CLI::App& command, const std::string& examples);
/// Prints the one JSON document of --json.
void print_json(const nlohmann::ordered_json& document);

/// METHOD EXEMPLAR, [-p name=value]... [--seed N], and [--size WxH] [--periodic|--no-periodic] [--step S] [--origin
/// X,Y] of fit, synth and measure.
struct ModelOptions {
  std::string method, exemplar, size;
  std::vector<std::string> params;
  bool periodic = false, no_periodic = false;
  double step = 1;
  std::vector<double> origin;  ///< none: (0, 0)
  std::uint64_t seed = 1;

  void add_method_to(CLI::App& app, bool required = true);
  void add_params_to(CLI::App& app);
  void add_domain_to(CLI::App& app);
  /// Of an app that has the options of a domain.
  void add_origin_to(CLI::App& app);
  std::map<std::string, ParamValue> given_params(std::span<const ParamSpec> specs) const;
  Params read_params(const MethodEntry& entry) const;
  /// The size asked for, or 0x0 for the exemplar's own.
  Extent read_size() const;
  Point2 read_origin() const;
  /// What to sample on. Without further words it is the exemplar's own torus, or a window of its size where the method
  /// serves no torus; for a size of one's own, a window of the plane.
  Domain read_domain(const MethodEntry& entry, const Problem& problem, const Params& options) const;
};

/// A file, or the name of a config below configs/ ("lectures2022/rpn_adsn").
std::filesystem::path find_config(const std::filesystem::path& home, const std::string& name_or_file);
/// Every experiment config below configs/, sorted: all but the exemplars' catalog and the claims.
std::vector<std::filesystem::path> all_configs(const std::filesystem::path& home);
/// The named ones, or all when none is named.
std::vector<std::filesystem::path> chosen_configs(const std::filesystem::path& home,
                                                  const std::vector<std::string>& names);
/// --profile quick|full
void add_profile_option(CLI::App& app, Profile* profile);

/// Tells on standard error which exemplars are missing and where to get them.
void tell_missing(const Plan& plan);

}  // namespace textonbench::cli
