#include "gpu/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "gpu/program.h"
#include "gpu/texture.h"

namespace textonbench {
namespace {

constexpr double furthest_from_base = 0x1p20;
constexpr int group_side = 16;  // of compute.glsl
/// Mesa's software ends all loops of an invocation after 65535 turns in all, without a word. There are up to four
/// impacts to a useful fetch.
constexpr double most_software_turns = 65535;
constexpr double turns_a_fetch = 4;

constexpr std::string_view vertex_text =
    "void main() {  // one triangle over the frame\n"
    "  gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0);\n"
    "}\n";

std::vector<ShaderStage> stages_of(const ContextInfo& info, const ShaderRecipe& recipe, ShaderPath path,
                                   const SurfaceScene* scene) {
  const std::string_view version = info.compute() ? "430 core" : "410 core";
  const auto defines = surface_defines(recipe, scene);
  if (path == ShaderPath::compute) {
    return {{GL_COMPUTE_SHADER, shader_source(version, "compute.glsl", recipe, defines)}};
  }
  const ShaderSource vertex{fmt::format("#version {}\n#line 1 0\n{}", version, vertex_text), {"the triangle"}};
  return {{GL_VERTEX_SHADER, vertex}, {GL_FRAGMENT_SHADER, shader_source(version, "fragment.glsl", recipe, defines)}};
}

/// A coordinate relative to the base in 2^−10 pixel, and 32 bits below.
std::pair<std::int32_t, std::uint32_t> fixed_point(double pixels) {
  const double coarse = std::floor(pixels * 1024);
  return {static_cast<std::int32_t>(coarse), static_cast<std::uint32_t>((pixels * 1024 - coarse) * 0x1p32)};
}

void require_grid(const Frame& frame) {
  const Eigen::Vector2d whole = frame.origin.array().round();
  if (frame.ground || frame.surface || frame.supersampling != 1 || frame.step != 1 || frame.origin != whole) {
    throw std::invalid_argument(fmt::format(
        "frame from ({}, {}) of step {} and {} x {} samples a pixel{}: this noise has values at whole points of the "
        "plane alone; expected a raster of the plane from a whole point, of step 1 and one sample a pixel",
        frame.origin.x(), frame.origin.y(), frame.step, frame.supersampling, frame.supersampling,
        frame.ground    ? " of the ground"
        : frame.surface ? " of a surface"
                        : ""));
  }
}

void require_reach(const Eigen::Vector2d& corner) {
  if (!(corner.cwiseAbs().maxCoeff() < furthest_from_base)) {
    throw std::invalid_argument(
        fmt::format("frame with a point ({}, {}) from the base of its recipe: expected less than 2^20 pixels; make the "
                    "recipe near the frame",
                    corner.x(), corner.y()));
  }
}

}  // namespace

struct Renderer::Resources {
  Resources(Context& context, const ShaderRecipe& recipe, ShaderPath path, const SurfaceScene* scene)
      : program(context, stages_of(context.info(), recipe, path, scene)), frame(context, (recipe.channels + 3) / 4) {
    if (scene != nullptr) surface.emplace(context, recipe, *scene);
  }

  /// The recipe's textures stay bound to the units in their order.
  void set_recipe(const ShaderRecipe& recipe, Program& shader) const {
    shader.use();
    std::int32_t unit = 0;
    for (const ShaderTexture& texture : recipe.textures) shader.set(texture.sampler, unit++);
    for (const ShaderWords& words : recipe.words) shader.set(words.sampler, unit++);
    for (const auto& [name, value] : recipe.uniforms) shader.set(name, value);
  }

  Program program;
  std::optional<Surface> surface;
  std::vector<Texture> textures;
  FrameTarget frame;
};

Renderer::Renderer(Context& context, const ShaderRecipe& recipe, ShaderPath path,
                   const std::optional<SurfaceScene>& asked)
    : context_(context),
      path_(path),
      channels_(recipe.channels),
      turns_(std::max(recipe.turns, turns_a_fetch * recipe.useful_fetches)),
      base_(recipe.base),
      on_grid_(recipe.on_grid),
      shader_(recipe.shader) {
  if (recipe.channels < 1 || recipe.channels > 8) {
    throw std::invalid_argument(fmt::format("recipe of {} channels: expected 1 to 8", recipe.channels));
  }
  if (path == ShaderPath::compute && !context.info().compute()) {
    throw GpuError(fmt::format("compute shaders need OpenGL 4.3, and {} has {}.{}: take the fragment path",
                               context.info().renderer, context.info().major, context.info().minor));
  }
  context.make_current();
  std::optional<SurfaceScene> scene = asked;
  if (recipe.mesh != nullptr) {
    if (!scene) scene.emplace();
    scene->mesh = recipe.mesh;
    view_ = SurfaceView{.tilt = recipe.tilt};
  }
  resources_ = std::make_unique<Resources>(context, recipe, path, scene ? &*scene : nullptr);
  context.check("compiling the shader of " + recipe.shader);
  for (const ShaderTexture& texture : recipe.textures) resources_->textures.emplace_back(context, texture);
  for (const ShaderWords& words : recipe.words) resources_->textures.emplace_back(context, words);
  if (resources_->surface) resources_->set_recipe(recipe, resources_->surface->program());
  Program& program = resources_->program;
  resources_->set_recipe(recipe, program);
  if (path == ShaderPath::compute) {
    program.set("channels_0", std::int32_t{0});
    program.set("channels_1", std::int32_t{1});
  }
  context.check("setting the uniforms of " + recipe.shader);
}

Renderer::~Renderer() {
  try {
    context_.make_current();
  } catch (const GpuError&) {
    // A context that is gone has taken its objects along.
  }
}

Frame Renderer::prepare(const Frame& asked) {
  Frame frame = asked;
  if (!frame.surface) frame.surface = view_;
  if (frame.size.width < 1 || frame.size.height < 1 || frame.supersampling < 1 || frame.supersampling > 64) {
    throw std::invalid_argument(
        fmt::format("frame of {}x{} pixels of {} x {} samples: expected at least one pixel and "
                    "1 to 64 samples a side",
                    frame.size.width, frame.size.height, frame.supersampling, frame.supersampling));
  }
  if (!(std::isfinite(frame.step) && frame.step > 0 && frame.step < furthest_from_base)) {
    throw std::invalid_argument(fmt::format("frame of step {}: expected a finite one above 0", frame.step));
  }
  const int samples_a_pass = frame.surface ? 1 : frame.supersampling;
  if (on_grid_) require_grid(frame);
  if (context_.info().software && turns_ * samples_a_pass > most_software_turns) {
    throw GpuError(fmt::format(
        "{} turns of loops for {} samples of a pixel in a pass: {} ends loops after {}; take fewer impacts, or the "
        "processor",
        turns_ * samples_a_pass, samples_a_pass, context_.info().renderer, most_software_turns));
  }
  if (frame.surface.has_value() != resources_->surface.has_value()) {
    throw std::invalid_argument(frame.surface ? "frame of a surface by a renderer without a scene"
                                              : "frame of the plane by a renderer of a surface");
  }
  context_.make_current();
  resources_->frame.resize(frame.size);
  const int n = frame.supersampling;
  Eigen::Vector2d first = frame.origin - base_;
  if (frame.surface) {
    require_reach(first);
  } else if (!frame.ground) {
    const Eigen::Vector2d size(frame.size.width, frame.size.height);
    require_reach(first);
    require_reach(first + frame.step * size);
    first.array() += frame.step * (0.5 / n - 0.5);
  }
  Program& program = resources_->program;
  program.use();
  program.set("frame_size", std::array<std::int32_t, 2>{frame.size.width, frame.size.height});
  program.set("supersampling", std::int32_t{n});
  const auto [x, x_fraction] = fixed_point(first.x());
  const auto [y, y_fraction] = fixed_point(first.y());
  program.set("origin_coarse", std::array<std::int32_t, 2>{x, y});
  program.set("origin_fraction", std::array<std::uint32_t, 2>{x_fraction, y_fraction});
  const auto [step, step_fraction] = fixed_point(frame.step / n);
  program.set("step_coarse", std::int32_t{step});
  program.set("step_fraction", step_fraction);
  program.set("step_pixels", static_cast<float>(frame.step / n));
  const GroundViewOptions ground = frame.ground.value_or(GroundViewOptions{});
  if (frame.ground) {
    const GroundView view(frame.size, ground);
    for (int row = 0; row < frame.size.height; ++row) {
      for (const int column : {0, frame.size.width - 1}) {
        if (view.covers(column, row)) {
          require_reach(first + view.point(column, row));
        }
      }
    }
  }
  program.set("is_ground", std::int32_t{frame.ground ? 1 : 0});
  program.set("camera", std::array<float, 4>{static_cast<float>(ground.height),
                                             static_cast<float>(frame.size.width / 2.0 / std::tan(ground.field / 2)),
                                             static_cast<float>(std::sin(ground.pitch)),
                                             static_cast<float>(std::cos(ground.pitch))});
  program.set("furthest", static_cast<float>(ground.furthest));
  program.set("sample_row", std::int32_t{0});
  for (std::size_t unit = 0; unit < resources_->textures.size(); ++unit) {
    resources_->textures[unit].bind(static_cast<GLuint>(unit));
  }
  if (frame.surface) {
    Surface& surface = *resources_->surface;
    const std::vector<std::pair<std::string, ShaderValue>> origin{
        {"origin_coarse", std::array<std::int32_t, 2>{x, y}},
        {"origin_fraction", std::array<std::uint32_t, 2>{x_fraction, y_fraction}}};
    surface.prepare(frame.size, *frame.surface, frame.step, origin);
    program.use();
    surface.bind(program, static_cast<int>(resources_->textures.size()));
    Surface::set_view(program, *frame.surface);
  }
  program.require_all_set(shader_);
  resources_->frame.bind(path_ == ShaderPath::compute);
  return frame;
}

void Renderer::submit(const Frame& frame) {
  const int n = frame.supersampling;
  for (int pass = 0; pass < (frame.surface ? n * n : n); ++pass) {
    if (frame.surface) {
      // In whole samples from the middle one.
      const int row = pass / n, column = pass % n;
      const Eigen::Vector2d sample(column - (n - 1) / 2.0, row - (n - 1) / 2.0);
      resources_->surface->draw(sample / n);
      resources_->program.use();
      resources_->frame.bind(path_ == ShaderPath::compute);
    }
    submit_pass(frame, pass);
  }
}

void Renderer::submit_pass(const Frame& frame, int pass) {
  const GlFunctions& gl = context_.gl();
  const auto groups = [](int pixels) { return static_cast<GLuint>((pixels + group_side - 1) / group_side); };
  resources_->program.set("sample_row", std::int32_t{pass});
  if (path_ == ShaderPath::compute) {
    gl.DispatchCompute(groups(frame.size.width), groups(frame.size.height), 1);
    gl.MemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  } else {
    pass == 0 ? gl.Disable(GL_BLEND) : gl.Enable(GL_BLEND);
    gl.BlendFunc(GL_ONE, GL_ONE);
    gl.DrawArrays(GL_TRIANGLES, 0, 3);
  }
}

Image Renderer::draw(const Frame& asked) {
  const Frame frame = prepare(asked);
  submit(frame);
  Image image = resources_->frame.read(channels_);
  context_.check(fmt::format("drawing a frame of {}x{} pixels", frame.size.width, frame.size.height));
  return image;
}

std::vector<double> Renderer::time(const Frame& asked, int warm_up, int count) {
  const Frame frame = prepare(asked);
  const GlFunctions& gl = context_.gl();
  for (int i = 0; i < warm_up; ++i) {
    submit(frame);
  }
  gl.Finish();
  std::vector<GLuint> queries(static_cast<std::size_t>(count));
  gl.GenQueries(count, queries.data());
  for (const GLuint query : queries) {
    gl.BeginQuery(GL_TIME_ELAPSED, query);
    submit(frame);
    gl.EndQuery(GL_TIME_ELAPSED);
  }
  std::vector<double> milliseconds;
  milliseconds.reserve(queries.size());
  for (const GLuint query : queries) {
    GLuint64 nanoseconds = 0;
    gl.GetQueryObjectui64v(query, GL_QUERY_RESULT, &nanoseconds);
    milliseconds.push_back(1e-6 * static_cast<double>(nanoseconds));
  }
  gl.DeleteQueries(count, queries.data());
  context_.check(fmt::format("timing frames of {}x{} pixels", frame.size.width, frame.size.height));
  return milliseconds;
}

}  // namespace textonbench
