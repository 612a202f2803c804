#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <stdexcept>

#include "experiments/cli/command.h"
#include "experiments/cli/table.h"
#include "experiments/gpu_run.h"
#include "experiments/metrics/metric.h"
#include "experiments/observation.h"
#include "experiments/provenance.h"

namespace textonbench::cli {
namespace {

struct MeasureOptions {
  ModelOptions model;
  int samples = 8;
  std::vector<std::string> gpu;
  std::vector<std::string> metrics;
  bool json = false;
};

/// All options of drawing on a graphics processor, when one of them is given.
std::map<std::string, ParamValue> read_gpu_options(const std::vector<std::string>& assignments) {
  if (assignments.empty()) return {};
  std::map<std::string, ParamValue> given;
  for (const std::string& assignment : assignments) given.insert(parse_param(gpu_run_options(), assignment));
  return Params(gpu_run_options(), given).values();
}

/// What is measured when no metric is named.
std::vector<std::string> usual_metrics(const RunSpec& spec) {
  std::vector<std::string> names;
  for (const MetricEntry& metric : metric_catalog()) {
    std::string name(metric.name);
    if (metric.identity || metric.level == MetricLevel::frame) continue;
    if (object_to_gpu({name}, !spec.gpu.empty(), spec.periodic)) continue;
    names.push_back(std::move(name));
  }
  return names;
}

RunSpec make_spec(const MeasureOptions& options, const ExemplarInfo& exemplar, const ExemplarCatalog& catalog) {
  const MethodEntry& method = find_method(options.model.method);
  RunSpec spec;
  spec.method = options.model.method;
  const Params params = options.model.read_params(method);
  spec.params = params.values();
  spec.file_sha256 = hash_named(method, spec.params, catalog);
  spec.exemplar = options.model.exemplar;
  spec.exemplar_sha256 = exemplar_sha256(exemplar);
  spec.size = options.model.read_size();
  const Exemplar pixels = load_exemplar(exemplar);
  std::optional<Exemplar> second;
  if (const auto named = second_exemplar(method, spec.params, catalog)) second = load_exemplar(*named);
  const std::optional<Observation> observed = observation(method, spec.params, pixels.pixels.extent());
  const Problem problem{pixels, second ? &*second : nullptr, observed ? &*observed : nullptr};
  spec.periodic = options.model.read_domain(method, problem, params).periodic;
  spec.step = options.model.step;
  spec.seed = options.model.seed;
  spec.samples = options.samples;
  spec.gpu = read_gpu_options(options.gpu);
  spec.metrics = options.metrics.empty() ? usual_metrics(spec) : options.metrics;
  for (const std::string& name : spec.metrics) find_metric(name);
  std::sort(spec.metrics.begin(), spec.metrics.end());
  return spec;
}

std::string number(const Record& value) {
  return value.is_null() ? std::string() : fmt::format("{:.4g}", value.get<double>());
}

void print_metrics(const Record& metrics) {
  std::vector<std::vector<std::string>> rows;
  for (const MetricEntry& entry : metric_catalog()) {
    const auto metric = metrics.find(entry.name);
    if (metric == metrics.end()) continue;
    const Record& deviation = (*metric)["stderr"];
    rows.push_back({std::string(entry.name), number((*metric)["value"]), deviation.is_null() ? "" : "±",
                    number(deviation), number((*metric)["floor"]), std::string(entry.unit)});
  }
  print_table({{"METRIC"}, {"VALUE", Align::right}, {""}, {"STDERR", Align::right}, {"FLOOR", Align::right}, {"UNIT"}},
              rows);
}

int measure(const MeasureOptions& options, const GlobalOptions& globals) {
  const tbb::global_control threads = limit_threads(globals);
  const ExemplarCatalog catalog(home_folder());
  const ExemplarInfo exemplar = find_exemplar(catalog, options.model.exemplar);
  const RunSpec spec = make_spec(options, exemplar, catalog);
  const Record record = execute_run(spec, catalog, nullptr);
  if (record["status"] == "refused") {
    throw std::invalid_argument(fmt::format("{} cannot do this: {}", spec.method, record["reason"].get<std::string>()));
  }
  if (options.json) {
    Record document = {
        {"method", spec.method},        {"exemplar", spec.exemplar}, {"params", record["spec"]["params"]},
        {"metrics", record["metrics"]}, {"id", record["id"]},        {"spec", record["spec"]},
        {"time", record["time"]}};
    if (!spec.gpu.empty()) document["gpu"] = record["provenance"]["gpu"];
    print_json(document);
    return 0;
  }
  print_metrics(record["metrics"]);
  if (!globals.quiet) {
    fmt::print(stderr,
               "\n{} samples, {:.1f} s. ± is the standard error over the samples; the floor is what samples of the "
               "exact Gaussian law score.\n",
               spec.samples, record["time"]["wall_seconds"].get<double>());
  }
  return 0;
}

}  // namespace

Command measure_command(CLI::App& app, const GlobalOptions& globals) {
  const auto options = std::make_shared<MeasureOptions>();
  CLI::App* command = app.add_subcommand("measure", "Measure how good and how fast one model is");
  options->model.add_method_to(*command);
  options->model.add_params_to(*command);
  options->model.add_domain_to(*command);
  command->add_option("--samples", options->samples, "Samples to draw")
      ->capture_default_str()
      ->check(CLI::Range(1, 100000));
  command
      ->add_option("--gpu", options->gpu,
                   "NAME=VALUE, repeatable: draw the samples on a graphics processor, with this option of it "
                   "(path, fetch, filter, window, half, supersampling, pitch, height)")
      ->allow_extra_args(false);
  command->add_option("--metrics", options->metrics, "Comma-separated metrics (all but tests of theory)")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_flag("--json", options->json, "Print one JSON document");
  set_examples(*command,
               "  textonbench measure adsn mamurk_a_1 --samples 16 --metrics mean_error,skewness\n"
               "  textonbench measure texton_noise mamurk_a_1 --gpu path=compute --size 1024x1024 --samples 1 "
               "--metrics frame_ms");
  return {command, [options, &globals] { return measure(*options, globals); }};
}

}  // namespace textonbench::cli
