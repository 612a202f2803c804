#include "experiments/cli/frame_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace textonbench::cli {

void FrameOptions::add_to(CLI::App& app) {
  given_ = {app.add_option("--scene", options_.scene,
                           "What is drawn: plane, ground (under a camera), sphere, torus or a Wavefront OBJ file")
                ->capture_default_str()
                ->type_name("plane|ground|sphere|torus|FILE.obj"),
            app.add_option("--supersampling", options_.supersampling, "N: mean of N x N points a pixel")
                ->capture_default_str()
                ->check(CLI::Range(1, 64))};
  const auto number = [&app](const char* name, double* value, double least, double most, const char* help) {
    return app.add_option(name, *value, help)->capture_default_str()->check(CLI::Range(least, most));
  };
  of_ground_ = {
      number("--height", &options_.height, 1e-3, 1e6, "Of the camera above the ground, in pixels of the exemplar"),
      number("--pitch", &options_.pitch, 1, 89, "Of its line of sight below the horizon, degrees"),
      number("--field", &options_.field, 1, 170, "Its horizontal angle of view, degrees"),
      number("--furthest", &options_.furthest, 1e-3, 256,
             "Longest side of a pixel on the ground, in pixels of the exemplar")};
  tilt_option_ = app.add_option("--tilt", tilt_, "Height of the viewer of a surface above its horizon, degrees (35)")
                     ->check(CLI::Range(-90.0, 90.0));
  of_surface_ = {
      tilt_option_,
      number("--azimuth", &options_.azimuth, -360, 360, "Turn of a surface about its vertical axis, degrees"),
      number("--zoom", &options_.zoom, 1e-3, 1e3, "How much larger a surface is than the picture, with its texture"),
      number("--bump", &options_.bump, -1e6, 1e6,
             "Shades a surface as if a unit of the texture were so many of its pixels high"),
      number("--displacement", &options_.displacement, -1e6, 1e6,
             "Moves the corners of a surface's mesh by so many pixels of the texture for a unit above 1/2")};
  given_.insert(given_.end(), of_ground_.begin(), of_ground_.end());
  given_.insert(given_.end(), of_surface_.begin(), of_surface_.end());
}

bool FrameOptions::any_given() const {
  return std::ranges::any_of(given_, [](const CLI::Option* option) { return option->count() > 0; });
}

SceneOptions FrameOptions::read(const ShaderRecipe& recipe) const {
  const bool is_ground = options_.scene == "ground";
  const bool is_surface = recipe.mesh != nullptr || (!is_ground && options_.scene != "plane");
  const auto require = [&](const std::vector<const CLI::Option*>& all, bool belong, const char* expected) {
    for (const CLI::Option* option : all) {
      if (option->count() > 0 && !belong) {
        throw std::invalid_argument(
            fmt::format("{} on the scene {}: expected {}", option->get_name(), options_.scene, expected));
      }
    }
  };
  require(of_ground_, is_ground, "--scene ground");
  require(of_surface_, is_surface, "--scene sphere, torus or FILE.obj, or surface_noise on a surface");
  SceneOptions options = options_;
  if (tilt_option_->count() > 0) options.tilt = tilt_;
  return options;
}

}  // namespace textonbench::cli
