#include "experiments/scene.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <numbers>
#include <stdexcept>

namespace textonbench {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double usual_tilt = 35;

std::shared_ptr<const TriangleMesh> mesh_of_scene(const std::string& scene) {
  if (scene == "sphere" || scene == "torus") return std::make_shared<const TriangleMesh>(solid_mesh(scene));
  if (!std::filesystem::is_regular_file(scene)) {
    throw std::invalid_argument(
        fmt::format("scene {}: no such file; expected plane, ground, sphere, torus or a Wavefront OBJ file", scene));
  }
  return std::make_shared<const TriangleMesh>(read_obj(scene));
}

}  // namespace

std::optional<SurfaceScene> surface_scene(const SceneOptions& options, const ShaderRecipe& recipe) {
  const bool is_flat = options.scene == "plane" || options.scene == "ground";
  const bool is_displaced = options.displacement != 0, is_bumpy = options.bump != 0 || is_displaced;
  if (recipe.mesh != nullptr) {
    if (options.scene != "plane") {
      throw std::invalid_argument(
          fmt::format("scene {} of a model that has a surface of its own: expected none, and the surface as an option "
                      "of the method",
                      options.scene));
    }
    return SurfaceScene{.mesh = recipe.mesh, .bumpy = is_bumpy, .displaced = is_displaced};
  }
  if (is_flat && is_bumpy) {
    throw std::invalid_argument(fmt::format(
        "bump {} and displacement {} on the scene {}: expected a surface: sphere, torus or a Wavefront OBJ file",
        options.bump, options.displacement, options.scene));
  }
  if (is_flat) return std::nullopt;
  return SurfaceScene{.mesh = mesh_of_scene(options.scene), .bumpy = is_bumpy, .displaced = is_displaced};
}

Frame scene_frame(const SceneOptions& options, const Domain& domain, const ShaderRecipe& recipe) {
  Frame frame;
  frame.size = domain.size;
  frame.origin = {domain.origin.x, domain.origin.y};
  frame.step = domain.step;
  frame.supersampling = options.supersampling;
  if (options.scene == "ground") {
    frame.ground = GroundViewOptions{.height = options.height,
                                     .pitch = options.pitch * degree,
                                     .field = options.field * degree,
                                     .furthest = options.furthest};
  } else if (options.scene != "plane" || recipe.mesh != nullptr) {
    const double own_tilt = recipe.mesh != nullptr ? recipe.tilt : usual_tilt * degree;
    frame.surface = SurfaceView{.tilt = options.tilt ? *options.tilt * degree : own_tilt,
                                .azimuth = options.azimuth * degree,
                                .zoom = options.zoom,
                                .bump = options.bump != 0 ? options.bump : options.displacement,
                                .displacement = options.displacement};
  }
  return frame;
}

}  // namespace textonbench
