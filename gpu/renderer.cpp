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
constexpr double most_software_fetches = 65535.0 / 4;

constexpr std::string_view vertex_text =
    "void main() {  // one triangle over the frame\n"
    "  gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0);\n"
    "}\n";

std::vector<ShaderStage> stages_of(const ContextInfo& info, const ShaderRecipe& recipe, ShaderPath path) {
  const std::string_view version = info.compute() ? "430 core" : "410 core";
  if (path == ShaderPath::compute) {
    return {{GL_COMPUTE_SHADER, shader_source(version, "compute.glsl", recipe)}};
  }
  const ShaderSource vertex{fmt::format("#version {}\n#line 1 0\n{}", version, vertex_text), {"the triangle"}};
  return {{GL_VERTEX_SHADER, vertex}, {GL_FRAGMENT_SHADER, shader_source(version, "fragment.glsl", recipe)}};
}

/// A coordinate relative to the base in 2^−10 pixel, and 32 bits below.
std::pair<std::int32_t, std::uint32_t> fixed_point(double pixels) {
  const double coarse = std::floor(pixels * 1024);
  return {static_cast<std::int32_t>(coarse), static_cast<std::uint32_t>((pixels * 1024 - coarse) * 0x1p32)};
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
  Resources(Context& context, const ShaderRecipe& recipe, ShaderPath path)
      : program(context, stages_of(context.info(), recipe, path)), frame(context, (recipe.channels + 3) / 4) {}

  Program program;
  std::vector<Texture> textures;
  FrameTarget frame;
};

Renderer::Renderer(Context& context, const ShaderRecipe& recipe, ShaderPath path)
    : context_(context),
      path_(path),
      channels_(recipe.channels),
      fetches_(recipe.useful_fetches),
      base_(recipe.base),
      shader_(recipe.shader) {
  if (recipe.channels < 1 || recipe.channels > 8) {
    throw std::invalid_argument(fmt::format("recipe of {} channels: expected 1 to 8", recipe.channels));
  }
  if (path == ShaderPath::compute && !context.info().compute()) {
    throw GpuError(fmt::format("compute shaders need OpenGL 4.3, and {} has {}.{}: take the fragment path",
                               context.info().renderer, context.info().major, context.info().minor));
  }
  context.make_current();
  resources_ = std::make_unique<Resources>(context, recipe, path);
  context.check("compiling the shader of " + recipe.shader);
  Program& program = resources_->program;
  program.use();
  for (const ShaderTexture& texture : recipe.textures) {
    program.set(texture.sampler, static_cast<std::int32_t>(resources_->textures.size()));
    resources_->textures.emplace_back(context, texture);
  }
  for (const ShaderWords& words : recipe.words) {
    program.set(words.sampler, static_cast<std::int32_t>(resources_->textures.size()));
    resources_->textures.emplace_back(context, words);
  }
  for (const auto& [name, value] : recipe.uniforms) {
    program.set(name, value);
  }
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

void Renderer::prepare(const Frame& frame) {
  if (frame.size.width < 1 || frame.size.height < 1 || frame.supersampling < 1 || frame.supersampling > 64) {
    throw std::invalid_argument(
        fmt::format("frame of {}x{} pixels of {} x {} samples: expected at least one pixel and "
                    "1 to 64 samples a side",
                    frame.size.width, frame.size.height, frame.supersampling, frame.supersampling));
  }
  if (!(std::isfinite(frame.step) && frame.step > 0 && frame.step < furthest_from_base)) {
    throw std::invalid_argument(fmt::format("frame of step {}: expected a finite one above 0", frame.step));
  }
  if (context_.info().software && fetches_ * frame.supersampling > most_software_fetches) {
    throw GpuError(
        fmt::format("{} fetches a row of samples, {} in a row: {} ends loops that long before they are done; take "
                    "fewer impacts, or "
                    "the processor",
                    fetches_ * frame.supersampling, frame.supersampling, context_.info().renderer));
  }
  context_.make_current();
  resources_->frame.resize(frame.size);
  const int n = frame.supersampling;
  Eigen::Vector2d first = frame.origin - base_;
  if (!frame.ground) {
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
  program.require_all_set(shader_);
  for (std::size_t unit = 0; unit < resources_->textures.size(); ++unit) {
    resources_->textures[unit].bind(static_cast<GLuint>(unit));
  }
  resources_->frame.bind(path_ == ShaderPath::compute);
}

void Renderer::submit(const Frame& frame) {
  const GlFunctions& gl = context_.gl();
  const auto groups = [](int pixels) { return static_cast<GLuint>((pixels + group_side - 1) / group_side); };
  for (int row = 0; row < frame.supersampling; ++row) {
    resources_->program.set("sample_row", std::int32_t{row});
    if (path_ == ShaderPath::compute) {
      gl.DispatchCompute(groups(frame.size.width), groups(frame.size.height), 1);
      gl.MemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
    } else {
      row == 0 ? gl.Disable(GL_BLEND) : gl.Enable(GL_BLEND);
      gl.BlendFunc(GL_ONE, GL_ONE);
      gl.DrawArrays(GL_TRIANGLES, 0, 3);
    }
  }
}

Image Renderer::draw(const Frame& frame) {
  prepare(frame);
  submit(frame);
  Image image = resources_->frame.read(channels_);
  context_.check(fmt::format("drawing a frame of {}x{} pixels", frame.size.width, frame.size.height));
  return image;
}

std::vector<double> Renderer::time(const Frame& frame, int warm_up, int count) {
  prepare(frame);
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
