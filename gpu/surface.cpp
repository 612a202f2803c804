#include "gpu/surface.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "gpu/texture.h"
#include "methods/base/surface_view.h"

namespace textonbench {
namespace {

using Eigen::Vector3d;

constexpr std::array<const char*, 5> samplers{"surface_place", "surface_normal", "surface_coordinate", "surface_right",
                                              "surface_down"};
constexpr std::size_t numbers_a_corner = 8;  // place, normal, coordinate

std::vector<ShaderStage> stages_of_surface(const ContextInfo& info, const ShaderRecipe& recipe,
                                           const SurfaceScene& scene) {
  const std::string_view version = info.compute() ? "430 core" : "410 core";
  const auto defines = surface_defines(recipe, &scene);
  return {{GL_VERTEX_SHADER, shader_source(version, "surface_vertex.glsl", recipe, defines)},
          {GL_FRAGMENT_SHADER, shader_source(version, "surface_fragment.glsl", recipe, defines)}};
}

/// Root of the area in space over that of the coordinates, all triangles together.
double scale_of_coordinates(const TriangleMesh& mesh, const std::vector<Vector3d>& vertices) {
  double in_space = 0, on_plane = 0;
  for (const auto& triangle : mesh.triangles) {
    const auto corner = [&](std::size_t i) { return static_cast<std::size_t>(triangle[i]); };
    const Vector3d a = vertices[corner(1)] - vertices[corner(0)], b = vertices[corner(2)] - vertices[corner(0)];
    const Eigen::Vector2d u = mesh.coordinates[corner(1)] - mesh.coordinates[corner(0)];
    const Eigen::Vector2d v = mesh.coordinates[corner(2)] - mesh.coordinates[corner(0)];
    in_space += a.cross(b).norm();
    on_plane += std::abs(u.x() * v.y() - u.y() * v.x());
  }
  if (!(on_plane > 0)) {
    throw std::invalid_argument("mesh whose texture coordinates have no area: expected an unwrapped surface");
  }
  return std::sqrt(in_space / on_plane);
}

std::array<float, 4> direction(const Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()), 0};
}

std::array<float, 2> pair_of(const Eigen::Vector2d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y())};
}

void require_view(const SurfaceView& view) {
  const auto require = [](const char* what, double value, double least, double most) {
    if (!(value >= least && value <= most)) {
      throw std::invalid_argument(
          fmt::format("view of a surface with {} {}: expected {} to {}", what, value, least, most));
    }
  };
  constexpr double turn = 2 * std::numbers::pi;
  require("tilt", view.tilt, -turn / 4, turn / 4);
  require("azimuth", view.azimuth, -100 * turn, 100 * turn);
  require("zoom", view.zoom, 1e-3, 1e3);
  require("bump", view.bump, -1e6, 1e6);
  require("displacement", view.displacement, -1e6, 1e6);
}

}  // namespace

std::vector<std::pair<std::string, std::string>> surface_defines(const ShaderRecipe& recipe,
                                                                 const SurfaceScene* scene) {
  std::vector<std::pair<std::string, std::string>> defines{{"IN_SPACE", recipe.in_space ? "1" : "0"}};
  const bool bumpy = scene != nullptr && scene->bumpy;
  if (scene != nullptr) defines.emplace_back("SURFACE", "1");
  if (bumpy) defines.emplace_back("BUMPY", "1");
  if (scene != nullptr && scene->displaced) defines.emplace_back("DISPLACED", "1");
  const bool is_derivative = recipe.derivative >= 0;
  if (is_derivative) defines.emplace_back("DERIVATIVE", std::to_string(recipe.derivative));
  defines.emplace_back("GRADIENTS", bumpy || is_derivative ? "1" : "0");
  if ((bumpy || is_derivative) && !recipe.gradients) {
    throw std::invalid_argument(
        fmt::format("derivatives of {}, which bump mapping takes: its shader has no gradients with these options; of "
                    "splines, expected order 1 or more and "
                    "no filter",
                    recipe.shader));
  }
  return defines;
}

Surface::Surface(Context& context, const ShaderRecipe& recipe, const SurfaceScene& scene)
    : context_(context),
      program_(context, stages_of_surface(context.info(), recipe, scene)),
      shader_(recipe.shader),
      buffers_(2),
      textures_(samplers.size()) {
  const TriangleMesh& mesh = *scene.mesh;
  const std::vector<Vector3d> vertices = place_in_ball(mesh, 1);
  const bool has_coordinates = !mesh.coordinates.empty();
  if (!has_coordinates && !recipe.in_space) {
    throw std::invalid_argument(
        fmt::format("{} on a mesh without texture coordinates: expected some at every corner (vt in an OBJ file), or "
                    "surface_noise, which needs none",
                    recipe.shader));
  }
  if (has_coordinates) coordinate_scale_ = scale_of_coordinates(mesh, vertices);
  std::vector<float> numbers;
  numbers.reserve(numbers_a_corner * vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    for (const Vector3d& v : {vertices[i], mesh.normals[i]}) {
      for (const double x : v) numbers.push_back(static_cast<float>(x));
    }
    const Eigen::Vector2d place = has_coordinates ? mesh.coordinates[i] : Eigen::Vector2d::Zero();
    for (const double x : place) numbers.push_back(static_cast<float>(x));
  }
  const GlFunctions& gl = context.gl();
  corners_ = static_cast<GLsizei>(3 * mesh.triangles.size());
  gl.GenVertexArrays(1, &vertices_);
  gl.BindVertexArray(vertices_);
  gl.GenBuffers(2, buffers_.data());
  gl.BindBuffer(GL_ARRAY_BUFFER, buffers_[0]);
  gl.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(sizeof(float) * numbers.size()), numbers.data(),
                GL_STATIC_DRAW);
  gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers_[1]);
  gl.BufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(sizeof(mesh.triangles[0]) * mesh.triangles.size()),
                mesh.triangles.data(), GL_STATIC_DRAW);
  constexpr std::array<GLint, 3> components{3, 3, 2};
  std::uintptr_t offset = 0;
  for (GLuint i = 0; i < components.size(); ++i) {
    gl.EnableVertexAttribArray(i);
    gl.VertexAttribPointer(i, components[i], GL_FLOAT, GL_FALSE, numbers_a_corner * sizeof(float),
                           reinterpret_cast<const void*>(offset));  // NOLINT(performance-no-int-to-ptr)
    offset += sizeof(float) * static_cast<std::uintptr_t>(components[i]);
  }
  gl.BindVertexArray(0);
  context.check(fmt::format("uploading a mesh of {} triangles", mesh.triangles.size()));
}

Surface::~Surface() {
  release();
  context_.gl().DeleteBuffers(2, buffers_.data());
  context_.gl().DeleteVertexArrays(1, &vertices_);
}

void Surface::release() {
  const GlFunctions& gl = context_.gl();
  gl.DeleteTextures(static_cast<GLsizei>(textures_.size()), textures_.data());
  gl.DeleteFramebuffers(1, &framebuffer_);
  gl.DeleteRenderbuffers(1, &depth_);
  std::ranges::fill(textures_, 0);
  framebuffer_ = depth_ = 0;
  size_ = {0, 0};
}

void Surface::resize(Extent size) {
  if (size == size_) return;
  require_drawable(context_, size);
  release();
  const GlFunctions& gl = context_.gl();
  framebuffer_ = make_float_framebuffer(context_, size, textures_);
  gl.GenRenderbuffers(1, &depth_);
  gl.BindRenderbuffer(GL_RENDERBUFFER, depth_);
  gl.RenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, size.width, size.height);
  gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_);
  context_.check(fmt::format("making the frame of a surface, {}x{} pixels", size.width, size.height));
  if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw GpuError(
        fmt::format("{} does not draw surfaces to float32 textures: take another --context, or the processor",
                    context_.info().renderer));
  }
  size_ = size;
}

void Surface::prepare(Extent size, const SurfaceView& view, double step,
                      std::span<const std::pair<std::string, ShaderValue>> origin) {
  require_view(view);
  resize(size);
  program_.use();
  const double radius = picture_radius(size) * view.zoom, pixel_step = step / view.zoom;
  program_.set("picture", std::array{static_cast<float>(size.width), static_cast<float>(size.height)});
  program_.set("radius", static_cast<float>(radius));
  // Heights are within 4 of the middle but for values that no picture has.
  program_.set("farthest", static_cast<float>(1.01 * radius + 4 * std::abs(view.displacement) / pixel_step));
  program_.set("pixel_step", static_cast<float>(pixel_step));
  program_.set("coordinate_scale", static_cast<float>(coordinate_scale_ * radius * pixel_step));
  program_.set("displacement", static_cast<float>(view.displacement));
  for (const auto& [name, value] : origin) program_.set(name, value);
  set_view(program_, view);
  program_.set("middle", pair_of(Eigen::Vector2d::Zero()));
  program_.require_all_set(shader_);
}

void Surface::set_view(Program& shader, const SurfaceView& view) {
  const Eigen::Matrix3d rotation = view_rotation(view.tilt, view.azimuth);
  shader.set("right", direction(rotation.row(0)));
  shader.set("down", direction(rotation.row(1)));
  shader.set("towards", direction(rotation.row(2)));
  // From above the viewer's left shoulder.
  shader.set("light", direction((rotation.transpose() * Vector3d(-0.6, -0.6, 1)).normalized()));
  shader.set("bump", static_cast<float>(view.bump));
}

void Surface::draw(const Eigen::Vector2d& from_center) {
  const GlFunctions& gl = context_.gl();
  program_.use();
  program_.set("middle", pair_of(Eigen::Vector2d((size_.width - 1) / 2.0, (size_.height - 1) / 2.0) - from_center));
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  gl.BindVertexArray(vertices_);
  gl.Viewport(0, 0, size_.width, size_.height);
  constexpr std::array<float, 4> nothing{};
  constexpr float furthest = 1;
  for (GLint i = 0; i < static_cast<GLint>(textures_.size()); ++i) gl.ClearBufferfv(GL_COLOR, i, nothing.data());
  gl.ClearBufferfv(GL_DEPTH, 0, &furthest);
  gl.Disable(GL_BLEND);
  gl.Enable(GL_DEPTH_TEST);
  gl.DrawElements(GL_TRIANGLES, corners_, GL_UNSIGNED_INT, nullptr);
  gl.Disable(GL_DEPTH_TEST);
}

void Surface::bind(Program& shader, int first) const {
  const GlFunctions& gl = context_.gl();
  for (std::size_t i = 0; i < samplers.size(); ++i) {
    const int unit = first + static_cast<int>(i);
    gl.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    gl.BindTexture(GL_TEXTURE_2D, textures_[i]);
    shader.set(samplers[i], static_cast<std::int32_t>(unit));
  }
}

}  // namespace textonbench
