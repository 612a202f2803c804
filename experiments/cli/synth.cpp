#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <stdexcept>

#include "experiments/cli/command.h"
#include "experiments/execute.h"
#include "experiments/provenance.h"
#include "methods/base/image_io.h"

namespace textonbench::cli {
namespace {

struct SynthOptions {
  ModelOptions model;
  std::filesystem::path output;
  bool json = false;
};

int synthesize(const SynthOptions& options, const GlobalOptions& globals) {
  const tbb::global_control threads = limit_threads(globals);
  const ModelOptions& asked = options.model;
  const MethodEntry& method = find_method(asked.method);
  const Params params = asked.read_params(method);
  const Extent asked_size = asked.read_size();
  const ExemplarCatalog catalog(home_folder());
  std::vector<std::string> notes;
  const Exemplar exemplar = load_exemplar(find_exemplar(catalog, asked.exemplar), &notes);
  if (!globals.quiet) {
    for (const std::string& note : notes) fmt::print(stderr, "{}: {}\n", exemplar.name, note);
  }
  require_usable(exemplar);
  const Domain domain{.size = asked_size.area() > 0 ? asked_size : exemplar.pixels.extent(),
                      .periodic = asked.is_periodic()};
  const Problem problem{exemplar};
  if (const std::optional<std::string> reason = method.refuses(problem, params, domain)) {
    throw std::invalid_argument(fmt::format("{} cannot do this: {}", asked.method, *reason));
  }

  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  const std::unique_ptr<Model> model = method.analyze(problem, params, analysis_seed(asked.seed));
  const Clock::time_point analyzed = Clock::now();
  const Image sample = model->synthesize(domain, sample_seed(asked.seed, 0));
  const Clock::time_point done = Clock::now();
  write_image(sample, options.output);

  const double analyze_seconds = std::chrono::duration<double>(analyzed - start).count();
  const double synthesize_seconds = std::chrono::duration<double>(done - analyzed).count();
  if (options.json) {
    print_json({{"output", options.output.string()},
                {"seconds", {{"analyze", analyze_seconds}, {"synthesize", synthesize_seconds}}},
                {"seed", asked.seed},
                {"size", {domain.size.width, domain.size.height}},
                {"periodic", domain.periodic}});
    return 0;
  }
  fmt::print("{}: {}x{} {}, seed {} (analysis {:.1f} ms, synthesis {:.1f} ms)\n", options.output.string(),
             domain.size.width, domain.size.height, domain.periodic ? "torus" : "window", asked.seed,
             1e3 * analyze_seconds, 1e3 * synthesize_seconds);
  if (!globals.quiet) {
    fmt::print(stderr, "next: textonbench measure {} {} tells how good it is\n", asked.method, asked.exemplar);
  }
  return 0;
}

}  // namespace

Command synth_command(CLI::App& app, const GlobalOptions& globals) {
  const auto options = std::make_shared<SynthOptions>();
  CLI::App* synth = app.add_subcommand("synth", "Fit a model to an exemplar and draw one sample");
  options->model.add_to(*synth);
  synth->add_option("-o,--output", options->output, "Picture to write: .png (8 bit, clamped) or .exr (float)")
      ->required();
  synth->add_flag("--json", options->json, "Print one JSON document");
  set_examples(*synth,
               "  textonbench synth rpn mamurk_a_1 --seed 3 -o rpn.png\n"
               "  textonbench synth adsn photo.jpg --size 1024x768 -o large.png");
  return {synth, [options, &globals] { return synthesize(*options, globals); }};
}

}  // namespace textonbench::cli
