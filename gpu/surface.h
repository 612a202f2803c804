// Meshes under a camera: the places, normals and coordinates that the pixels of a frame see.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "gpu/program.h"
#include "methods/base/mesh.h"
#include "methods/base/shader_recipe.h"

namespace textonbench {

/// What a renderer is compiled for.
struct SurfaceScene {
  std::shared_ptr<const TriangleMesh> mesh;
  bool bumpy = false;      ///< normals are those of a relief of the texture, by its analytic gradient
  bool displaced = false;  ///< vertices are moved by that relief, outwards where it is above 1/2
};

/// The view of view_mesh() (surface_view.h): orthographic, of a mesh in a ball that fills the picture.
struct SurfaceView {
  double tilt = 0;     ///< height of the viewer above the plane of x and y, radians
  double azimuth = 0;  ///< turn of the object about the z axis, radians
  double zoom = 1;     ///< by how much the ball is larger, with its texture
  /// Of a unit of the relief, the mean of the first channels, at most three: pixels of the texture.
  double bump = 0, displacement = 0;
};

/// Defines of the shaders of a scene.
std::vector<std::pair<std::string, std::string>> surface_defines(const ShaderRecipe& recipe, const SurfaceScene* scene);

class Surface {
 public:
  /// Uploads the mesh. Throws std::invalid_argument for a mesh without coordinates, where the recipe needs them, and
  /// GpuError for one beyond the driver's memory. `recipe` displaces vertices.
  Surface(Context& context, const ShaderRecipe& recipe, const SurfaceScene& scene);
  ~Surface();
  Surface(const Surface&) = delete;
  Surface& operator=(const Surface&) = delete;

  /// The program that draws the mesh, whose uniforms of the recipe are to be set.
  Program& program() { return program_; }
  /// Throws GpuError for a size beyond the driver's limits or memory, std::invalid_argument for a view out of range.
  void prepare(Extent size, const SurfaceView& view, double step,
               std::span<const std::pair<std::string, ShaderValue>> origin);
  /// Draws what is seen at the pixels' centers and so far from them, pixels.
  void draw(const Eigen::Vector2d& from_center);
  /// Hands the textures to the shader that colors the pixels, at units from `first` on.
  void bind(Program& shader, int first) const;
  /// Sets the directions of a view, which that shader shades by.
  static void set_view(Program& shader, const SurfaceView& view);

 private:
  void resize(Extent size);
  void release();

  Context& context_;
  Program program_;
  std::string shader_;
  GLsizei corners_ = 0;
  double coordinate_scale_ = 0;  ///< lengths on the ball of radius 1 a coordinate
  std::vector<GLuint> buffers_;
  GLuint vertices_ = 0;
  Extent size_{0, 0};
  std::vector<GLuint> textures_;
  GLuint framebuffer_ = 0, depth_ = 0;
};

}  // namespace textonbench
