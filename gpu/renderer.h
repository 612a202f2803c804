// Draws the frames that a recipe describes.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gpu/context.h"
#include "gpu/surface.h"
#include "methods/base/ground_view.h"
#include "methods/base/image.h"
#include "methods/base/shader_recipe.h"

namespace textonbench {

/// fragment: one thread a pixel, all by itself. compute: a work group of 16 x 16 pixels shares what it needs of the
/// plane. Needs OpenGL 4.3.
enum class ShaderPath { fragment, compute };

/// What the pixels show: the points origin + step (i, j) of the plane, the ground under a camera, where pixels above
/// its end are 0, or a surface, on white, shaded by 1/4 + 3/4 of the cosine between normal and light, whose coordinates
/// begin at the origin. Pixels of the texture are `step` a pixel of a surface that faces the viewer.
struct Frame {
  Extent size;
  Eigen::Vector2d origin{0, 0};
  double step = 1;
  std::optional<GroundViewOptions> ground{};
  std::optional<SurfaceView> surface{};
  int supersampling = 1;  ///< n: the mean of n x n points a pixel
};

class Renderer {
 public:
  /// Compiles and uploads. `context` is to live longer. Throws GpuError for a shader that does not compile (with the
  /// log, in the files' own lines), a texture beyond the driver's limits or memory, and a path that the context has
  /// not. With a scene, all frames show its mesh, else none. Throws std::invalid_argument for a mesh without
  /// coordinates or a recipe without gradients where they are needed.
  Renderer(Context& context, const ShaderRecipe& recipe, ShaderPath path,
           const std::optional<SurfaceScene>& scene = std::nullopt);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// In a pass for each row of a pixel's samples, of a surface for each sample, so that no shader runs for long. Throws
  /// GpuError for a frame beyond the driver's limits or memory, for a uniform or sampler that the shader reads and the
  /// recipe does not set, for a context that was lost and, in software, for more impacts than its loops count;
  /// std::invalid_argument for a frame that is empty or farther than 2^20 pixels from the recipe's base, one of a
  /// surface where there is none, and one that is no raster of whole points of a recipe that has no others.
  Image draw(const Frame& frame);

  /// Milliseconds of the graphics processor for each of `count` frames, by timer queries, after `warm_up` others.
  /// Nothing is read back.
  std::vector<double> time(const Frame& frame, int warm_up, int count);

 private:
  struct Resources;
  /// The frame that is shown.
  Frame prepare(const Frame& asked);
  void submit(const Frame& frame);
  void submit_pass(const Frame& frame, int pass);

  Context& context_;
  ShaderPath path_;
  int channels_;
  double turns_;
  std::optional<SurfaceView> view_;  ///< of frames that say nothing, by a recipe with a mesh
  Eigen::Vector2d base_;
  bool on_grid_;
  std::string shader_;
  std::unique_ptr<Resources> resources_;
};

}  // namespace textonbench
