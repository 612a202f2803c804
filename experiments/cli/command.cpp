#include "experiments/cli/command.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <map>
#include <stdexcept>
#include <thread>

namespace textonbench::cli {
namespace {

Extent parse_size(const std::string& text) {
  Extent size;
  const char* const end = text.data() + text.size();
  const auto width = std::from_chars(text.data(), end, size.width);
  if (width.ec == std::errc() && width.ptr != end && *width.ptr == 'x') {
    const auto height = std::from_chars(width.ptr + 1, end, size.height);
    if (height.ec == std::errc() && height.ptr == end && size.width > 0 && size.height > 0) return size;
  }
  throw std::invalid_argument(fmt::format("--size {}: expected WIDTHxHEIGHT in pixels, such as 512x512", text));
}

}  // namespace

int thread_count(const GlobalOptions& globals) {
  return globals.threads > 0 ? globals.threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

tbb::global_control limit_threads(const GlobalOptions& globals) {
  return {tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(thread_count(globals))};
}

void set_examples(CLI::App& command, const std::string& examples) {
  command.footer("Every subcommand also takes --threads, --results and --quiet (textonbench --help).\n\nExample:\n" +
                 examples);
}

void print_json(const nlohmann::ordered_json& document) { fmt::print("{}\n", document.dump(2)); }

void ModelOptions::add_method_to(CLI::App& app, bool required) {
  app.add_option("METHOD", method, "Method (textonbench list methods)")->required(required);
  app.add_option("EXEMPLAR", exemplar,
                 "Exemplar (textonbench list exemplars) or a picture file; or maps of one surface joined by +, modeled "
                 "together, of at most 8 channels in all (albedo.png+normal.png+height.png)")
      ->required(required);
}

void ModelOptions::add_params_to(CLI::App& app) {
  app.add_option("-p,--param", params, "Option of the method as name=value; may be repeated")->allow_extra_args(false);
  app.add_option("--seed", seed, "Any whole number from 0 to 2^64 - 1")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
}

void ModelOptions::add_domain_to(CLI::App& app) {
  app.add_option("--size", size, "Size of a sample as WIDTHxHEIGHT (the exemplar's own)");
  CLI::Option* torus = app.add_flag("--periodic", periodic, "Sample a torus (usual without --size)");
  app.add_flag("--no-periodic", no_periodic, "Sample a window of the plane (usual with --size)")->excludes(torus);
  app.add_option("--step", step, "Distance of a sample's pixels in pixels of the exemplar, for noises of the plane")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
}

void ModelOptions::add_origin_to(CLI::App& app) {
  app.add_option("--origin", origin, "Place X,Y of a window's first pixel, in pixels of the exemplar (0,0)")
      ->delimiter(',')
      ->expected(2)
      ->type_name("X,Y")
      ->excludes(app.get_option("--periodic"));
}

std::map<std::string, ParamValue> ModelOptions::given_params(std::span<const ParamSpec> specs) const {
  std::map<std::string, ParamValue> given;
  for (const std::string& assignment : params) {
    auto [name, value] = parse_param(specs, assignment);
    given.insert_or_assign(std::move(name), std::move(value));
  }
  return given;
}

Params ModelOptions::read_params(const MethodEntry& entry) const { return {entry.params, given_params(entry.params)}; }

Domain ModelOptions::read_domain(const MethodEntry& entry, const Problem& problem, const Params& options) const {
  const Extent asked = read_size();
  Domain domain{.size = asked.area() > 0 ? asked : problem.exemplar.pixels.extent(),
                .origin = read_origin(),
                .step = step,
                .periodic = periodic || (size.empty() && !no_periodic && origin.empty())};
  if (!periodic && domain.periodic && entry.refuses(problem, options, domain)) {
    Domain window = domain;
    window.periodic = false;
    if (!entry.refuses(problem, options, window)) return window;
  }
  return domain;
}

Point2 ModelOptions::read_origin() const { return origin.empty() ? Point2{} : Point2{origin[0], origin[1]}; }

Extent ModelOptions::read_size() const { return size.empty() ? Extent{} : parse_size(size); }

std::filesystem::path find_config(const std::filesystem::path& home, const std::string& name_or_file) {
  if (std::filesystem::is_regular_file(name_or_file)) return name_or_file;
  const std::filesystem::path folder = home / "configs";
  if (std::filesystem::path named = folder / (name_or_file + ".toml"); std::filesystem::is_regular_file(named)) {
    return named;
  }
  std::vector<std::string> known;
  for (const std::filesystem::path& file : all_configs(home)) {
    known.push_back(file.lexically_relative(folder).replace_extension().generic_string());
  }
  const std::vector<std::string_view> candidates(known.begin(), known.end());
  throw std::invalid_argument(fmt::format("{}: no such file, and no config of that name{} (textonbench list configs)",
                                          name_or_file, did_you_mean(name_or_file, candidates)));
}

std::vector<std::filesystem::path> all_configs(const std::filesystem::path& home) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(home / "configs")) {
    const std::filesystem::path& file = entry.path();
    const bool is_claims = file.parent_path() == home / "configs" / "claims";
    if (file.extension() == ".toml" && file.filename() != "exemplars.toml" && !is_claims) files.push_back(file);
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<std::filesystem::path> chosen_configs(const std::filesystem::path& home,
                                                  const std::vector<std::string>& names) {
  if (names.empty()) return all_configs(home);
  std::vector<std::filesystem::path> files;
  files.reserve(names.size());
  for (const std::string& name : names) files.push_back(find_config(home, name));
  return files;
}

void add_profile_option(CLI::App& app, Profile* profile) {
  const std::map<std::string, Profile> names{{"quick", Profile::quick}, {"full", Profile::full}};
  app.add_option("--profile", *profile, "quick (minutes, the default) or full (as in the papers)")
      ->transform(CLI::CheckedTransformer(names).description(""))
      ->type_name("quick|full");
}

void tell_missing(const Plan& plan) {
  for (const MissingExemplar& missing : plan.missing) {
    fmt::print(stderr, "{} runs left out: exemplar {} is not here; {}\n", missing.runs, missing.name,
               missing.how_to_get);
  }
}

}  // namespace textonbench::cli
