// How a graphics processor evaluates a model: plain data that a renderer compiles, fills and draws, without knowing the
// method. A further method needs a GLSL file in gpu/shaders and a recipe that names it.
//
// The GLSL file defines
//
//   void texture_at(PlanePoint point, mat2 footprint, PlaneBox tile, out float values[CHANNELS]);
//
// with the types of gpu/shaders/plane.glsl: the value of the field at a point whose pixel has the footprint's columns
// as its sides. A compute shader calls it in all invocations of a work group together, and `tile` then holds all their
// points; a fragment shader calls it for one point at a time. Where GRADIENTS is 1, a recipe with `gradients` also has
//
//   void gradient_at(PlanePoint point, mat2 footprint, PlaneBox tile, out float values[CHANNELS],
//                    out vec2 gradients[CHANNELS]);
//
// and one `in_space` has texture_in_space() and gradient_in_space() of a SpacePoint (gpu/shaders/space.glsl) too.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "methods/base/image.h"
#include "methods/base/mesh.h"
#include "methods/base/random.h"

namespace textonbench {

/// How texels are read. manual: by texelFetch and weights in float32, to rounding what the processor computes; with a
/// filter, by the level and the probes that the shader chooses from the footprint (Mesa's llvmpipe 22.3 takes no notice
/// of it in its own anisotropic filter). hardware: by the texture unit, whose positions between texels have 8 bits.
enum class ShaderFetch { hardware, manual };

/// How a kernel is filtered by the footprint of a pixel: not at all, by the nearest level of its mip chain, or by the
/// texture unit's trilinear or anisotropic (16 probes) filter.
enum class ShaderFilter { none, mipmap, trilinear, anisotropic };

/// The impacts that a pixel visits: all that its filtered kernel reaches, or those that the unfiltered one reaches, as
/// where texture coordinates outside [0, 1] are skipped. The latter cuts filtered kernels.
enum class ShaderWindow { footprint, kernel };

/// What a model is asked for.
struct ShaderRequest {
  Seed seed{};
  Eigen::Vector2d near{0, 0};  ///< frames lie within 2^20 pixels of it, itself within 2^40 of the origin
  ShaderFetch fetch = ShaderFetch::hardware;
  ShaderFilter filter = ShaderFilter::none;
  ShaderWindow window = ShaderWindow::footprint;
  bool half_float = false;  ///< texels of 16 bits instead of 32
  int channels = 0;         ///< only so many, the first ones; 0: all
};

/// A texture array of one to four components, zero outside its texels.
struct ShaderTexture {
  std::string sampler;  ///< name of its sampler2DArray
  Extent size;
  int layers = 1;
  int components = 1;
  bool half_float = false;
  /// Of the filter between the texels of a level, between levels, and along the longer side of a footprint.
  bool linear = false;
  ShaderFilter filter = ShaderFilter::none;
  /// Texel c of (x, y) of a layer is [((layer * height + y) * width + x) * components + c]. Level l, if there is more
  /// than one, has the size max(1, width >> l) x max(1, height >> l).
  std::vector<std::vector<float>> levels;
};

/// Words in a usamplerBuffer of that name.
struct ShaderWords {
  std::string sampler;
  std::vector<std::uint32_t> words;
};

using ShaderValue =
    std::variant<std::int32_t, std::uint32_t, float, std::array<std::int32_t, 2>, std::array<float, 2>,
                 std::array<float, 4>, std::array<std::uint32_t, 2>, std::array<std::uint32_t, 4>, std::vector<float>>;

struct ShaderRecipe {
  std::string shader;  ///< name of a file of gpu/shaders, without .glsl
  int channels = 1;    ///< CHANNELS, 1 to 8
  /// Point of the plane that a PlanePoint of zeros is, in pixels, a multiple of 2^−10.
  Eigen::Vector2d base{0, 0};
  std::vector<std::pair<std::string, std::string>> defines;
  std::vector<std::pair<std::string, ShaderValue>> uniforms;
  std::vector<ShaderTexture> textures;
  std::vector<ShaderWords> words;
  /// Texture fetches that a pixel needs on average: those that its value depends on.
  double useful_fetches = 0;
  /// Turns of loops that a pixel takes, where they are more than four a useful fetch.
  double turns = 0;
  bool gradients = false;
  /// What frames show: the values (−1), or their derivatives by x (0) or y (1).
  int derivative = -1;
  bool in_space = false;
  /// Values exist at whole points of the plane alone: rasters of whole corners, step 1 and a sample a pixel.
  bool on_grid = false;
  /// What a model lives on, if it does, seen from `tilt` radians above the plane of x and y (surface_view.h).
  std::shared_ptr<const TriangleMesh> mesh{};
  double tilt = 0;
};

}  // namespace textonbench
