#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "experiments/cli/command.h"
#include "experiments/cli/fitted.h"
#include "experiments/cli/frame_options.h"
#include "experiments/cli/gpu_options.h"
#include "experiments/cli/sample_file.h"
#include "experiments/execute.h"
#include "experiments/frame_timing.h"
#include "experiments/model_file.h"
#include "experiments/progress.h"
#include "experiments/shader_models.h"
#include "methods/base/image_io.h"
#include "methods/base/image_io_tiled.h"
#include "methods/spot/spot_noise.h"
#include "methods/spot/texton_noise.h"

namespace textonbench::cli {
namespace {

struct SynthOptions {
  ModelOptions model;
  std::filesystem::path model_file;
  std::filesystem::path output;
  GpuOptions gpu;
  FrameOptions frame;
  bool on_gpu = false;
  bool json = false;
};

using Clock = std::chrono::steady_clock;

/// The parameters of the noise: given on the command line, or else those that the file was fitted with, or else
/// defaults.
Params noise_params(const std::vector<ParamSpec>& specs, const ModelFile& file, const ModelOptions& asked) {
  std::map<std::string, ParamValue> given;
  for (const ParamSpec& spec : specs) {
    if (const auto kept = file.params.find(std::string(spec.name)); kept != file.params.end()) given.insert(*kept);
  }
  for (auto& [name, value] : asked.given_params(specs)) given.insert_or_assign(name, value);
  return {specs, given};
}

/// The noise of a texton that was fitted before.
Fitted read_fitted(const SynthOptions& options) {
  const ModelOptions& asked = options.model;
  const Clock::time_point start = Clock::now();
  const bool is_text = options.model_file.extension() == ".texton";
  const ModelFile file = is_text ? read_texton_as_model(options.model_file) : read_model_file(options.model_file);
  const Extent asked_size = asked.read_size();
  const Domain domain{.size = asked_size.area() > 0 ? asked_size : Extent{512, 512},
                      .origin = asked.read_origin(),
                      .step = asked.step,
                      .periodic = asked.periodic};
  if (const std::optional<std::string> reason =
          file.order ? refuse_spline_noise(domain) : refuse_spot_noise(file.texton.extent(), domain)) {
    throw std::invalid_argument(fmt::format("{} cannot do this: {}", options.model_file.string(), *reason));
  }
  const std::vector<ParamSpec> specs = file.order ? spline_noise_params() : spot_noise_params("poisson");
  const Params params = noise_params(specs, file, asked);
  std::unique_ptr<Model> model =
      file.order ? make_spline_noise(file.spline_texton(), spline_noise_options(params))
                 : make_spot_noise(file.texton, spot_noise_options(params, file.texton.support_pixels));
  return {std::move(model), file.maps, domain, std::chrono::duration<double>(Clock::now() - start).count()};
}

/// Windows above this are drawn and written band by band, so that the memory they take does not grow with their height.
constexpr std::int64_t most_pixels_at_once = std::int64_t{1} << 24;

/// Draws a window of the sample.
using Draw = std::function<Image(const Domain&)>;

void draw_bands(const Draw& draw, const Fitted& fitted, const std::filesystem::path& output, bool quiet) {
  const Domain& domain = fitted.domain;
  std::optional<TiledImageWriter> writer;
  Domain window = domain;
  const int bands = (domain.size.height + TiledImageWriter::tile - 1) / TiledImageWriter::tile;
  Progress progress(static_cast<std::size_t>(bands), "bands", !quiet, {});
  for (int band = 0; band < bands; ++band) {
    const int top = band * TiledImageWriter::tile;
    window.origin.y = domain.origin.y + top * domain.step;
    window.size.height = std::min(TiledImageWriter::tile, domain.size.height - top);
    const Image image = draw(window);
    if (!writer) writer.emplace(output, domain.size, image.channels(), fitted.maps);
    writer->write_band(image);
    progress.advance("");
  }
  writer->finish();
}

/// A renderer and what it shows.
struct GpuDrawing {
  std::unique_ptr<Renderer> renderer;
  ShaderRecipe recipe;
  SceneOptions scene;
};

GpuDrawing prepare_drawing(const SynthOptions& options, const Fitted& fitted, Context& context, Seed seed) {
  if (fitted.domain.periodic) {
    throw std::invalid_argument("--renderer gpu draws windows of the plane: expected --no-periodic or --size");
  }
  ShaderRequest request = options.gpu.read_request(seed);
  const Domain& domain = fitted.domain;
  request.near = {domain.origin.x + domain.step * domain.size.width / 2,
                  domain.origin.y + domain.step * domain.size.height / 2};
  const std::string name = options.model.method.empty() ? options.model_file.string() : options.model.method;
  GpuDrawing drawing{.renderer = nullptr, .recipe = shader_of(*fitted.model, name, request), .scene = {}};
  drawing.scene = options.frame.read(drawing.recipe);
  drawing.renderer = std::make_unique<Renderer>(context, drawing.recipe, options.gpu.read_path(context.info()),
                                                surface_scene(drawing.scene, drawing.recipe));
  return drawing;
}

int synthesize(const SynthOptions& options, const GlobalOptions& globals) {
  const tbb::global_control threads = limit_threads(globals);
  const ModelOptions& asked = options.model;
  const bool from_file = !options.model_file.empty();
  if (from_file != asked.method.empty() || from_file != asked.exemplar.empty()) {
    throw std::invalid_argument("synth: expected either METHOD EXEMPLAR or --model FILE");
  }
  if ((options.gpu.any_given() || options.frame.any_given()) && !options.on_gpu) {
    throw std::invalid_argument("options of --renderer gpu without it: expected --renderer gpu");
  }
  const std::unique_ptr<Context> context = options.on_gpu ? options.gpu.make_context() : nullptr;
  const Fitted fitted = from_file ? read_fitted(options) : fit_to_exemplar(asked, globals.quiet);
  const Domain& domain = fitted.domain;
  if (const auto warning = fitted.model->warning(domain)) {
    fmt::print(stderr, "textonbench: warning: {}: {}\n", from_file ? options.model_file.string() : asked.method,
               *warning);
  }
  std::vector<std::filesystem::path> files{options.output};
  const Seed seed = sample_seed(asked.seed, 0);
  std::optional<GpuDrawing> gpu;
  if (context) gpu = prepare_drawing(options, fitted, *context, seed);
  const Draw draw = [&](const Domain& window) {
    return gpu ? gpu->renderer->draw(scene_frame(gpu->scene, window, gpu->recipe))
               : fitted.model->synthesize(window, seed);
  };
  const bool is_flat = !gpu || (gpu->scene.scene == "plane" && gpu->recipe.mesh == nullptr);
  const Clock::time_point start = Clock::now();
  double synthesize_seconds = 0;
  if (domain.size.area() > most_pixels_at_once && !domain.periodic && is_flat && options.output.extension() == ".exr") {
    draw_bands(draw, fitted, options.output, globals.quiet);
    synthesize_seconds = std::chrono::duration<double>(Clock::now() - start).count();
  } else {
    const Image sample = draw(domain);
    synthesize_seconds = std::chrono::duration<double>(Clock::now() - start).count();
    files = write_sample(sample, fitted.maps, options.output);
  }

  std::vector<std::string> names;
  names.reserve(files.size());
  for (const std::filesystem::path& file : files) names.push_back(file.string());
  if (options.json) {
    nlohmann::ordered_json document = {{"output", options.output.string()},
                                       {"files", names},
                                       {"seconds", {{"analyze", fitted.seconds}, {"synthesize", synthesize_seconds}}},
                                       {"seed", asked.seed},
                                       {"size", {domain.size.width, domain.size.height}},
                                       {"periodic", domain.periodic},
                                       {"step", domain.step},
                                       {"origin", {domain.origin.x, domain.origin.y}}};
    if (context) document["gpu"] = to_json(context->info());
    print_json(document);
    return 0;
  }
  fmt::print("{}: {}x{} {}, seed {} (analysis {:.1f} ms, synthesis {:.1f} ms{})\n", fmt::join(names, " "),
             domain.size.width, domain.size.height, domain.periodic ? "torus" : "window", asked.seed,
             1e3 * fitted.seconds, 1e3 * synthesize_seconds, context ? " by " + renderer_label(context->info()) : "");
  if (!globals.quiet && !from_file) {
    fmt::print(stderr, "next: textonbench measure {} {} tells how good it is\n", asked.method, asked.exemplar);
  }
  return 0;
}

}  // namespace

Command synth_command(CLI::App& app, const GlobalOptions& globals) {
  const auto options = std::make_shared<SynthOptions>();
  CLI::App* synth = app.add_subcommand("synth", "Fit a model to an exemplar, or read one, and draw one sample");
  options->model.add_method_to(*synth, false);
  options->model.add_params_to(*synth);
  options->model.add_domain_to(*synth);
  options->model.add_origin_to(*synth);
  synth->add_option(
      "--model", options->model_file,
      "Instead of METHOD EXEMPLAR: a model that textonbench fit wrote (.json), or a .texton; -p then takes "
      "impacts, mni and route, and intensity, or cell for B-splines, and a sample has 512x512 pixels without --size");
  synth
      ->add_option(
          "-o,--output", options->output,
          "Picture to write: .png (8 bit, clamped) or .exr (float); .exr of a window above 4096x4096 is drawn and "
          "written in tiles, in little memory. Maps of a stack are the channels MAP.R, MAP.G, MAP.B or MAP.Y of one "
          ".exr, or one .png each: OUTPUT_MAP.png")
      ->required();
  const auto renderer = [options](const std::string& name) { options->on_gpu = name == "gpu"; };
  synth->add_option_function<std::string>("--renderer", renderer, "Who draws: cpu, or gpu for noise of the plane (cpu)")
      ->check(CLI::IsMember({"cpu", "gpu"}))
      ->type_name("cpu|gpu");
  options->gpu.add_to(*synth);
  options->frame.add_to(*synth);
  synth->add_flag("--json", options->json, "Print one JSON document");
  set_examples(*synth,
               "  textonbench synth rpn mamurk_a_1 --seed 3 -o rpn.png\n"
               "  textonbench synth adsn photo.jpg --size 1024x768 -o large.png\n"
               "  textonbench synth texton_noise albedo.png+normal.png+height.png --size 1024x1024 -o material.exr\n"
               "  textonbench synth texton_noise mamurk_e_1 --size 1024x768 --renderer gpu -o gpu.png\n"
               "  textonbench synth texton_noise HR_Cork -p order=3 --size 800x800 --renderer gpu --scene torus "
               "--bump 8 -o torus.png\n"
               "  textonbench synth --model texton.json -p impacts=stratified -p mni=5 -o from_file.png");
  return {synth, [options, &globals] { return synthesize(*options, globals); }};
}

}  // namespace textonbench::cli
