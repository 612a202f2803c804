// Textures that a shader reads, and those that a frame is drawn to.
#pragma once

#include <span>
#include <vector>

#include "gpu/context.h"
#include "methods/base/image.h"
#include "methods/base/shader_recipe.h"

namespace textonbench {

/// Throws GpuError for a frame larger than the driver draws, before anything of it is made.
void require_drawable(const Context& context, Extent size);

/// Fills `textures` with new ones of float32 pixels of four channels, which are fetched texel by texel, and returns a
/// new framebuffer, which is bound and draws to them in their order.
GLuint make_float_framebuffer(Context& context, Extent size, std::span<GLuint> textures);

class Texture {
 public:
  /// Throws GpuError for a size beyond the driver's limits or memory, and std::invalid_argument for texels that do not
  /// fit it.
  Texture(Context& context, const ShaderTexture& texture);
  Texture(Context& context, const ShaderWords& words);
  Texture(Texture&& other) noexcept;
  Texture& operator=(Texture&&) = delete;
  ~Texture();

  void bind(GLuint unit) const;

 private:
  /// A name, which the destructor deletes also where the rest of a constructor throws.
  Texture(Context& context, GLenum target);

  Context* context_;
  GLenum target_;
  GLuint name_ = 0;
  GLuint buffer_ = 0;
};

/// Float32 pixels, four channels a texture.
class FrameTarget {
 public:
  FrameTarget(Context& context, int groups) : context_(context), textures_(static_cast<std::size_t>(groups)) {}
  ~FrameTarget();
  FrameTarget(const FrameTarget&) = delete;
  FrameTarget& operator=(const FrameTarget&) = delete;

  /// Throws GpuError for a size beyond the driver's limits or memory.
  void resize(Extent size);
  void bind(bool as_images) const;
  Image read(int channels) const;

 private:
  void release();

  Context& context_;
  Extent size_{0, 0};
  std::vector<GLuint> textures_;
  GLuint framebuffer_ = 0;
  GLuint vertices_ = 0;
};

}  // namespace textonbench
