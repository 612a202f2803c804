#include "experiments/gpu_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "experiments/frame_timing.h"
#include "experiments/metrics/metric.h"
#include "experiments/metrics/reference_error.h"
#include "experiments/scene.h"
#include "experiments/shader_models.h"
#include "gpu/renderer.h"

namespace textonbench {
namespace {

/// Of the reference of supersampling_error, a side of the pixel.
constexpr int reference_samples = 20;
/// Time for the frames of one run in software.
constexpr double software_budget = 2;

using namespace std::string_view_literals;

const std::array gpu_param_specs{
    ParamSpec{.name = "path",
              .default_value = "fragment",
              .unit = "",
              .help = "shaders that draw",
              .choices = {"fragment", "compute"}},
    ParamSpec{.name = "fetch",
              .default_value = "hardware",
              .unit = "",
              .help = "who interpolates between texels: the texture unit, or instructions in float32",
              .choices = {"hardware", "manual"}},
    ParamSpec{.name = "filter",
              .default_value = "none",
              .unit = "",
              .help = "of kernels, by the footprint of a pixel",
              .choices = {"none", "mipmap", "trilinear", "anisotropic"}},
    ParamSpec{
        .name = "window",
        .default_value = "footprint",
        .unit = "",
        .help = "impacts that a filtered pixel visits: all that its kernel reaches, or those of the unfiltered one",
        .choices = {"footprint", "kernel"}},
    ParamSpec{.name = "half", .default_value = false, .unit = "", .help = "texels of 16 bits instead of 32"},
    ParamSpec{.name = "supersampling",
              .default_value = std::int64_t{1},
              .unit = "",
              .help = "n: the mean of n x n points a pixel",
              .min = 1,
              .max = 64},
    ParamSpec{.name = "pitch",
              .default_value = 0.0,
              .unit = "degree",
              .help = "of the line of sight below the horizon, of a camera over the ground; 0: the plane from above",
              .min = 0,
              .max = 89},
    ParamSpec{.name = "scene",
              .default_value = "plane",
              .unit = "",
              .help = "what is drawn where pitch is 0: the plane, or a surface by its coordinates",
              .choices = {"plane", "sphere", "torus"}},
    ParamSpec{.name = "bump",
              .default_value = 0.0,
              .unit = "pixel",
              .help = "height of a unit of the texture that shades a surface",
              .min = -1e6,
              .max = 1e6},
    ParamSpec{.name = "displacement",
              .default_value = 0.0,
              .unit = "pixel",
              .help = "height of a unit of the texture that moves the corners of a surface's mesh",
              .min = -1e6,
              .max = 1e6},
    ParamSpec{
        .name = "height", .default_value = 64.0, .unit = "pixel", .help = "of that camera", .min = 1e-3, .max = 1e6},
};

bool is_of_software(std::string_view metric) { return metric.starts_with("software_"); }
bool times_frames(std::string_view metric) { return metric.starts_with("frame_") || is_of_software(metric); }
bool times_processor(std::string_view metric) { return metric == "synthesize_seconds" || metric == "ns_per_pixel"; }

template <class Value>
Value option_value(std::string_view given, std::initializer_list<std::pair<std::string_view, Value>> names) {
  return std::ranges::find(names, given, &std::pair<std::string_view, Value>::first)->second;
}

/// This machine cannot, though another one may.
class CannotDrawHere : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class GpuDrawer : public FrameDrawer {
 public:
  /// Throws CannotDrawHere.
  explicit GpuDrawer(const RunSpec& spec)
      : spec_(spec), options_(gpu_run_options(), spec.gpu), context_(open_context(spec.metrics)) {
    const ContextInfo& info = context_->info();
    const bool wants_times = std::ranges::any_of(
        spec.metrics, [](const std::string& name) { return times_frames(name) && !is_of_software(name); });
    if (info.software && wants_times) {
      throw CannotDrawHere(fmt::format("needs a GPU: {} draws in software", info.renderer));
    }
    if (info.software && filter() == ShaderFilter::anisotropic && fetch() == ShaderFetch::hardware) {
      throw CannotDrawHere(fmt::format("needs a GPU: {} has no anisotropic filter of its own", info.renderer));
    }
    if (path() == ShaderPath::compute && !info.compute()) {
      throw CannotDrawHere(
          fmt::format("needs compute shaders, OpenGL 4.3 or newer: {} has {}", info.renderer, info.version));
    }
  }

  Image draw(const Model& model, const Domain& domain, Seed seed) override {
    return draw_with(domain, request(seed, filter()), model, supersampling());
  }

  double measure(std::string_view metric, const Model& model, const Domain& domain, Seed seed) override {
    if (metric == "supersampling_error" || metric == "sampler_filter_error") {
      if (model.spline_texton() == nullptr) {
        throw std::invalid_argument(fmt::format("{}: expected a method whose kernels are splines", metric));
      }
      const bool supersampled = metric == "supersampling_error";
      const Image expected =
          draw_with(domain, request(seed, ShaderFilter::none), model, supersampled ? reference_samples : 1);
      return distance_in_deviations(supersampled ? draw(model, domain, seed) : draw_unfiltered(model, domain, seed),
                                    expected, *model.spline_texton());
    }
    if (metric == "frame_color_ratio" || metric == "software_color_ratio") {
      ShaderRequest gray = request(seed, filter());
      gray.channels = 1;
      return time(model, domain, seed).milliseconds.median / time_with(domain, gray, model).milliseconds.median;
    }
    const FrameTiming& timing = time(model, domain, seed);
    if (metric == "frame_ms" || metric == "software_frame_ms") return timing.milliseconds.median;
    if (metric == "frame_ns_per_pixel" || metric == "software_ns_per_pixel") return timing.ns_per_pixel;
    if (metric == "frame_fetches_per_second") return timing.fetches_per_second;
    if (metric == "frame_ceiling_fraction") {
      if (timing.fetch_ceiling_fraction) return *timing.fetch_ceiling_fraction;
      throw std::invalid_argument(fmt::format("{}: expected a method whose shader fetches from textures", metric));
    }
    throw std::logic_error(fmt::format("nobody measures the frame metric \"{}\"", metric));
  }

  void describe(Record& record) const override {
    record["provenance"]["gpu"] = to_json(context_->info());
    if (timing_) record["timing"] = to_json(*timing_);
  }

 private:
  static std::unique_ptr<Context> open_context(const std::vector<std::string>& metrics) {
    try {
      return std::ranges::any_of(metrics, is_of_software) ? make_context(ContextKind::osmesa) : make_context();
    } catch (const GpuError& error) {
      throw CannotDrawHere(error.what());
    }
  }

  ShaderPath path() const {
    return option_value<ShaderPath>(options_.text("path"),
                                    {{"fragment"sv, ShaderPath::fragment}, {"compute"sv, ShaderPath::compute}});
  }
  ShaderFetch fetch() const {
    return option_value<ShaderFetch>(options_.text("fetch"),
                                     {{"hardware"sv, ShaderFetch::hardware}, {"manual"sv, ShaderFetch::manual}});
  }
  ShaderFilter filter() const {
    return option_value<ShaderFilter>(options_.text("filter"), {{"none"sv, ShaderFilter::none},
                                                                {"mipmap"sv, ShaderFilter::mipmap},
                                                                {"trilinear"sv, ShaderFilter::trilinear},
                                                                {"anisotropic"sv, ShaderFilter::anisotropic}});
  }

  int supersampling() const { return static_cast<int>(options_.integer("supersampling")); }

  ShaderRequest request(Seed seed, ShaderFilter filter) const {
    const auto window = option_value<ShaderWindow>(
        options_.text("window"), {{"footprint"sv, ShaderWindow::footprint}, {"kernel"sv, ShaderWindow::kernel}});
    return {.seed = seed, .fetch = fetch(), .filter = filter, .window = window, .half_float = options_.boolean("half")};
  }

  SceneOptions scene(int supersampling) const {
    SceneOptions scene{.scene = options_.text("scene"),
                       .supersampling = supersampling,
                       .bump = options_.number("bump"),
                       .displacement = options_.number("displacement")};
    if (const double pitch = options_.number("pitch"); pitch > 0) {
      if (scene.scene != "plane") {
        throw std::invalid_argument(
            fmt::format("gpu.pitch = {} with gpu.scene = {}: expected one of them", pitch, scene.scene));
      }
      scene.scene = "ground";
      scene.height = options_.number("height");
      scene.pitch = pitch;
      scene.field = GroundViewOptions{}.field * 180 / std::numbers::pi;
    }
    return scene;
  }

  Image draw_recipe(const Domain& domain, const ShaderRecipe& recipe, int supersampling) {
    const SceneOptions shown = scene(supersampling);
    return Renderer(*context_, recipe, path(), surface_scene(shown, recipe)).draw(scene_frame(shown, domain, recipe));
  }

  Image draw_with(const Domain& domain, const ShaderRequest& request, const Model& model, int supersampling) {
    return draw_recipe(domain, shader_of(model, spec_.method, request), supersampling);
  }

  /// By the shader of trilinear filtering in the kernels' own windows, on a texture without levels: what a filter is
  /// where it is only the texture's.
  Image draw_unfiltered(const Model& model, const Domain& domain, Seed seed) {
    ShaderRequest filtered = request(seed, ShaderFilter::trilinear);
    filtered.fetch = ShaderFetch::hardware;
    filtered.window = ShaderWindow::kernel;
    ShaderRecipe recipe = shader_of(model, spec_.method, filtered);
    for (ShaderTexture& texture : recipe.textures) {
      texture.filter = ShaderFilter::none;
      texture.levels.resize(1);
    }
    return draw_recipe(domain, recipe, 1);
  }

  FrameTiming time_with(const Domain& domain, const ShaderRequest& request, const Model& model) {
    const ShaderRecipe recipe = shader_of(model, spec_.method, request);
    const SceneOptions shown = scene(supersampling());
    return time_frames(*context_, recipe,
                       {.path = path(),
                        .frame = scene_frame(shown, domain, recipe),
                        .surface = surface_scene(shown, recipe),
                        .software_seconds = software_budget});
  }

  const FrameTiming& time(const Model& model, const Domain& domain, Seed seed) {
    if (!timing_) timing_ = time_with(domain, request(seed, filter()), model);
    return *timing_;
  }

  const RunSpec& spec_;
  Params options_;
  std::unique_ptr<Context> context_;
  std::optional<FrameTiming> timing_;
};

}  // namespace

std::span<const ParamSpec> gpu_run_options() { return gpu_param_specs; }

std::optional<GpuObjection> object_to_gpu(const std::vector<std::string>& metrics, bool on_gpu, bool periodic) {
  bool hardware = false, software = false;
  for (const std::string& name : metrics) {
    if (find_metric(name).level == MetricLevel::frame && !on_gpu) {
      return GpuObjection{
          "metrics", fmt::format("{} is of frames: expected options under gpu, such as gpu.path = \"fragment\"", name)};
    }
    if (on_gpu && times_processor(name)) {
      return GpuObjection{"metrics", fmt::format("{} is of samples that the processor synthesizes, and gpu has them "
                                                 "drawn as frames: expected frame_ms or frame_ns_per_pixel",
                                                 name)};
    }
    software = software || is_of_software(name);
    hardware = hardware || (times_frames(name) && !is_of_software(name));
  }
  if (hardware && software) {
    return GpuObjection{"metrics",
                        "frames of a run are drawn by a graphics processor or in software: expected its "
                        "metrics either all with names that begin with software_ or none"};
  }
  if (on_gpu && periodic) {
    return GpuObjection{"periodic", "periodic = true: expected false with options under gpu, which draws the plane"};
  }
  return std::nullopt;
}

Record execute_run(const RunSpec& spec, const ExemplarCatalog& exemplars, const ResultsFolder* results) {
  if (const auto objection = object_to_gpu(spec.metrics, !spec.gpu.empty(), spec.periodic)) {
    throw std::invalid_argument(objection->message);
  }
  if (spec.gpu.empty()) return execute(spec, exemplars, results);
  try {
    GpuDrawer drawer(spec);
    return execute(spec, exemplars, results, &drawer);
  } catch (const CannotDrawHere& reason) {
    return unsuccessful_record(spec, "refused", reason.what());
  }
}

}  // namespace textonbench
