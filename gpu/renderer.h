// Draws the frames that a recipe describes.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gpu/context.h"
#include "methods/base/ground_view.h"
#include "methods/base/image.h"
#include "methods/base/shader_recipe.h"

namespace textonbench {

/// fragment: one thread a pixel, all by itself. compute: a work group of 16 x 16 pixels shares what it needs of the
/// plane. Needs OpenGL 4.3.
enum class ShaderPath { fragment, compute };

/// What the pixels show: the points origin + step (i, j) of the plane, or the ground under a camera, where pixels above
/// its end are 0.
struct Frame {
  Extent size;
  Eigen::Vector2d origin{0, 0};
  double step = 1;
  std::optional<GroundViewOptions> ground{};
  int supersampling = 1;  ///< n: the mean of n x n points a pixel
};

class Renderer {
 public:
  /// Compiles and uploads. `context` is to live longer. Throws GpuError for a shader that does not compile (with the
  /// log, in the files' own lines), a texture beyond the driver's limits or memory, and a path that the context has
  /// not.
  Renderer(Context& context, const ShaderRecipe& recipe, ShaderPath path);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// In a pass for each row of a pixel's samples, so that no shader runs for long. Throws GpuError for a frame beyond
  /// the driver's limits or memory, for a uniform or sampler that the shader reads and the recipe does not set, for a
  /// context that was lost and, in software, for more impacts than its loops count; std::invalid_argument for a frame
  /// that is empty or farther than 2^20 pixels from the recipe's base.
  Image draw(const Frame& frame);

  /// Milliseconds of the graphics processor for each of `count` frames, by timer queries, after `warm_up` others.
  /// Nothing is read back.
  std::vector<double> time(const Frame& frame, int warm_up, int count);

 private:
  struct Resources;
  void prepare(const Frame& frame);
  void submit(const Frame& frame);

  Context& context_;
  ShaderPath path_;
  int channels_;
  double fetches_;
  Eigen::Vector2d base_;
  std::string shader_;
  std::unique_ptr<Resources> resources_;
};

}  // namespace textonbench
