#include <fmt/format.h>

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "experiments/cli/command.h"
#include "experiments/cli/fitted.h"
#include "experiments/cli/frame_options.h"
#include "experiments/cli/gpu_options.h"
#include "experiments/cli/table.h"
#include "experiments/execute.h"
#include "experiments/frame_timing.h"
#include "experiments/shader_models.h"

namespace textonbench::cli {
namespace {

struct FpsOptions {
  ModelOptions model;
  GpuOptions gpu;
  FrameOptions frame;
  int frames = 0;
  bool json = false;
};

/// What all paths have in common.
nlohmann::ordered_json describe(const FpsOptions& options, const Fitted& fitted, const ContextInfo& info,
                                const ShaderRecipe& recipe, const SceneOptions& scene) {
  nlohmann::ordered_json document = to_json(info);
  document["method"] = options.model.method;
  document["exemplar"] = options.model.exemplar;
  document["seed"] = options.model.seed;
  document["size"] = {fitted.domain.size.width, fitted.domain.size.height};
  document["supersampling"] = scene.supersampling;
  document["scene"] = scene.scene;
  document["bump"] = scene.bump;
  document["displacement"] = scene.displacement;
  document["channels"] = recipe.channels;
  if (!recipe.textures.empty()) {
    const SplineTexton* spline = fitted.model->spline_texton();
    const Extent texton = spline != nullptr ? spline->coefficients.extent() : recipe.textures.front().size;
    document["texton"] = {texton.width, texton.height};
    document["half"] = recipe.textures.front().half_float;
  }
  for (const auto& [name, value] : fitted.params) {
    std::visit([&document, &key = name](const auto& v) { document["params"][key] = v; }, value);
  }
  return document;
}

std::string in_units(double value) { return fmt::format("{:.4g}", value); }
std::string in_giga(const std::optional<double>& value) { return value ? in_units(1e-9 * *value) : "-"; }

void print_timings(const ContextInfo& info, const Fitted& fitted, const std::vector<FrameTiming>& timings) {
  const char* const per_second = info.software ? "SOFTWARE FPS" : "FPS";
  fmt::print("{}, {}, {}\n{}x{} pixels\n", renderer_label(info), info.vendor, info.version, fitted.domain.size.width,
             fitted.domain.size.height);
  std::vector<std::vector<std::string>> rows;
  rows.reserve(timings.size());
  for (const FrameTiming& timing : timings) {
    const FrameTimes& ms = timing.milliseconds;
    rows.push_back({std::string(shader_path_name(timing.path)), std::to_string(timing.frames), in_units(ms.median),
                    in_units(ms.min), in_units(ms.p05), in_units(ms.p95), in_units(timing.frames_per_second),
                    in_units(timing.ns_per_pixel), in_units(1e-9 * timing.fetches_per_second),
                    in_giga(timing.coherent_ceiling), in_giga(timing.incoherent_ceiling),
                    timing.fetch_ceiling_fraction ? in_units(*timing.fetch_ceiling_fraction) : "-"});
  }
  print_table({{"PATH"},
               {"FRAMES", Align::right},
               {"MEDIAN ms", Align::right},
               {"MIN", Align::right},
               {"5 %", Align::right},
               {"95 %", Align::right},
               {per_second, Align::right},
               {"ns/PIXEL", Align::right},
               {"GFETCH/s", Align::right},
               {"COHERENT", Align::right},
               {"INCOHERENT", Align::right},
               {"FRACTION", Align::right}},
              rows);
}

int time_method(const FpsOptions& options, const GlobalOptions& globals) {
  const tbb::global_control threads = limit_threads(globals);
  const std::unique_ptr<Context> context = options.gpu.make_context();
  const Fitted fitted = fit_to_exemplar(options.model, globals.quiet);
  const ShaderRecipe recipe =
      shader_of(*fitted.model, options.model.method, options.gpu.read_request(sample_seed(options.model.seed, 0)));
  const SceneOptions scene = options.frame.read(recipe);
  const std::optional<SurfaceScene> surface = surface_scene(scene, recipe);
  const std::vector<ShaderPath> paths = options.gpu.read_paths(context->info());
  std::vector<FrameTiming> timings;
  timings.reserve(paths.size());
  for (const ShaderPath path : paths) {
    timings.push_back(time_frames(*context, recipe,
                                  {.path = path,
                                   .frame = scene_frame(scene, {.size = fitted.domain.size}, recipe),
                                   .surface = surface,
                                   .frames = options.frames,
                                   .software_seconds = 10.0 / static_cast<double>(paths.size()),
                                   .show_progress = !globals.quiet}));
  }
  if (!options.json) {
    print_timings(context->info(), fitted, timings);
    if (context->info().software && !globals.quiet) {
      fmt::print(stderr, "\nDrawn in software, on this machine's processor: no graphics processor's frame rate.\n");
    }
    return 0;
  }
  nlohmann::ordered_json document = describe(options, fitted, context->info(), recipe, scene);
  if (timings.size() == 1) {
    document.update(to_json(timings.front()));
  } else {
    for (const FrameTiming& timing : timings) document["results"].push_back(to_json(timing));
  }
  print_json(document);
  return 0;
}

}  // namespace

Command fps_command(CLI::App& app, const GlobalOptions& globals) {
  const auto options = std::make_shared<FpsOptions>();
  CLI::App* fps = app.add_subcommand("fps", "Measure how fast a graphics processor draws a noise");
  options->model.add_method_to(*fps);
  options->model.add_params_to(*fps);
  options->model.size = "1024x1024";
  fps->add_option("--size", options->model.size, "Size of a frame as WIDTHxHEIGHT")->capture_default_str();
  options->gpu.add_to(*fps);
  fps->add_option("--frames", options->frames,
                  "Frames to time (200 after 20 to warm up; in software as many as take some ten seconds, 3 at least)")
      ->check(CLI::Range(1, 100000));
  options->frame.add_to(*fps);
  fps->add_flag("--json", options->json,
                "Print one JSON document; of --path all, what differs by path is in its list \"results\"");
  set_examples(*fps,
               "  textonbench fps texton_noise mamurk_e_1 -p impacts=poisson -p mni=30 -p support=64 --path all\n"
               "  textonbench fps texton_noise mamurk_e_1 --scene ground --filter anisotropic --size 1920x1080 --json");
  return {fps, [options, &globals] { return time_method(*options, globals); }};
}

}  // namespace textonbench::cli
