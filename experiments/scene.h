// What frames show, as a user names it.
#pragma once

#include <optional>
#include <string>

#include "gpu/renderer.h"
#include "methods/method.h"

namespace textonbench {

/// Angles are degrees.
struct SceneOptions {
  std::string scene = "plane";                                ///< plane, ground, sphere, torus, or a Wavefront OBJ file
  int supersampling = 1;                                      ///< N: the mean of N x N points a pixel
  double height = 64, pitch = 20, field = 60, furthest = 64;  ///< of the camera over the ground (ground_view.h)
  std::optional<double>
      tilt{};  ///< height of the viewer of a surface above its plane of x and y: 35, or the model's own
  double azimuth = 0, zoom = 1;  ///< of a surface (SurfaceView)
  /// Heights of a unit of the texture's relief, pixels of the texture. A displaced surface is bumpy by as much.
  double bump = 0, displacement = 0;
};

/// The mesh that a renderer of these frames needs, if any. Throws std::invalid_argument for a scene of another name
/// that is no file either, a file that read_obj() refuses, a scene besides the surface that the model has by itself,
/// and a relief without a surface.
std::optional<SurfaceScene> surface_scene(const SceneOptions& options, const ShaderRecipe& recipe);

/// The frame of a window of the plane, or of a scene that begins at its origin with its step.
Frame scene_frame(const SceneOptions& options, const Domain& domain, const ShaderRecipe& recipe);

}  // namespace textonbench
