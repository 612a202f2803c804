#include "gpu/texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

namespace textonbench {
namespace {

constexpr float most_probes = 16;

GLint limit(const Context& context, GLenum which) {
  GLint value = 0;
  context.gl().GetIntegerv(which, &value);
  return value;
}

std::string megabytes(double bytes) { return fmt::format("{:.4g} MB", 1e-6 * bytes); }

struct TexelFormat {
  GLint internal;
  GLenum layout;
};

TexelFormat texel_format(const ShaderTexture& texture) {
  constexpr std::array<GLenum, 4> layouts{GL_RED, GL_RG, GL_RGB, GL_RGBA};
  constexpr std::array<GLint, 4> half{GL_R16F, GL_RG16F, GL_RGB16F, GL_RGBA16F};
  constexpr std::array<GLint, 4> full{GL_R32F, GL_RG32F, GL_RGB32F, GL_RGBA32F};
  const auto index = static_cast<std::size_t>(texture.components - 1);
  return {texture.half_float ? half[index] : full[index], layouts[index]};
}

void require_texels(const Context& context, const ShaderTexture& texture) {
  if (texture.components < 1 || texture.components > 4 || texture.levels.empty()) {
    throw std::invalid_argument(fmt::format("texture {} of {} components and {} levels: expected 1 to 4, and a level",
                                            texture.sampler, texture.components, texture.levels.size()));
  }
  const GLint most = limit(context, GL_MAX_TEXTURE_SIZE);
  const GLint most_layers = limit(context, GL_MAX_ARRAY_TEXTURE_LAYERS);
  if (texture.size.width > most || texture.size.height > most || texture.layers > most_layers) {
    throw GpuError(
        fmt::format("texture {} of {}x{} texels and {} layers: {} takes at most {} a side and {} layers; take "
                    "smaller or fewer kernels",
                    texture.sampler, texture.size.width, texture.size.height, texture.layers, context.info().renderer,
                    most, most_layers));
  }
  for (std::size_t l = 0; l < texture.levels.size(); ++l) {
    const auto expected = static_cast<std::size_t>(std::max(1, texture.size.width >> l)) *
                          static_cast<std::size_t>(std::max(1, texture.size.height >> l)) *
                          static_cast<std::size_t>(texture.layers) * static_cast<std::size_t>(texture.components);
    if (texture.levels[l].size() != expected) {
      throw std::invalid_argument(fmt::format("level {} of texture {} has {} numbers: expected {}", l, texture.sampler,
                                              texture.levels[l].size(), expected));
    }
  }
}

bool has_extension(const Context& context, std::string_view wanted) {
  for (GLint i = 0; i < limit(context, GL_NUM_EXTENSIONS); ++i) {
    const auto* name = reinterpret_cast<const char*>(context.gl().GetStringi(GL_EXTENSIONS, static_cast<GLuint>(i)));
    if (name != nullptr && wanted == name) {
      return true;
    }
  }
  return false;
}

void set_filter(const Context& context, const ShaderTexture& texture) {
  const GlFunctions& gl = context.gl();
  const GLint inside = texture.linear ? GL_LINEAR : GL_NEAREST;
  const GLint between = texture.filter == ShaderFilter::none     ? inside
                        : texture.filter == ShaderFilter::mipmap ? GL_LINEAR_MIPMAP_NEAREST
                                                                 : GL_LINEAR_MIPMAP_LINEAR;
  gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, between);
  gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, inside);
  if (texture.filter == ShaderFilter::anisotropic) {
    if (context.info().software) {
      throw GpuError(fmt::format(
          "anisotropic filtering by {}, which ignores the gradients that a shader gives: take manual fetches",
          context.info().renderer));
    }
    GLfloat most = 0;
    if (context.info().at_least(4, 6) || has_extension(context, "GL_ARB_texture_filter_anisotropic") ||
        has_extension(context, "GL_EXT_texture_filter_anisotropic")) {
      gl.GetFloatv(GL_MAX_TEXTURE_MAX_ANISOTROPY, &most);
    }
    if (most < most_probes) {
      throw GpuError(fmt::format("anisotropic filtering with {} probes: {} does at most {}; take trilinear filtering",
                                 most_probes, context.info().renderer, most));
    }
    gl.TexParameterf(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAX_ANISOTROPY, most_probes);
  }
}

}  // namespace

void require_drawable(const Context& context, Extent size) {
  std::array<GLint, 2> most{};
  context.gl().GetIntegerv(GL_MAX_VIEWPORT_DIMS, most.data());
  for (GLint& side : most) {
    side = std::min(side, limit(context, GL_MAX_TEXTURE_SIZE));
  }
  if (size.width > most[0] || size.height > most[1]) {
    throw GpuError(fmt::format("frame of {}x{} pixels: {} draws at most {}x{}; take a smaller one, or the processor",
                               size.width, size.height, context.info().renderer, most[0], most[1]));
  }
}

GLuint make_float_framebuffer(Context& context, Extent size, std::span<GLuint> textures) {
  const GlFunctions& gl = context.gl();
  GLuint framebuffer = 0;
  gl.GenTextures(static_cast<GLsizei>(textures.size()), textures.data());
  gl.GenFramebuffers(1, &framebuffer);
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  std::vector<GLenum> targets;
  targets.reserve(textures.size());
  for (const GLuint texture : textures) {
    gl.BindTexture(GL_TEXTURE_2D, texture);
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, size.width, size.height, 0, GL_RGBA, GL_FLOAT, nullptr);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    targets.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(targets.size()));
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, targets.back(), GL_TEXTURE_2D, texture, 0);
  }
  gl.DrawBuffers(static_cast<GLsizei>(targets.size()), targets.data());
  return framebuffer;
}

Texture::Texture(Context& context, GLenum target) : context_(&context), target_(target) {
  context.gl().GenTextures(1, &name_);
  context.gl().BindTexture(target_, name_);
}

Texture::Texture(Context& context, const ShaderTexture& texture) : Texture(context, GL_TEXTURE_2D_ARRAY) {
  require_texels(context, texture);
  const GlFunctions& gl = context.gl();
  const TexelFormat format = texel_format(texture);
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
  for (std::size_t l = 0; l < texture.levels.size(); ++l) {
    gl.TexImage3D(target_, static_cast<GLint>(l), format.internal, std::max(1, texture.size.width >> l),
                  std::max(1, texture.size.height >> l), texture.layers, 0, format.layout, GL_FLOAT,
                  texture.levels[l].data());
  }
  gl.TexParameteri(target_, GL_TEXTURE_MAX_LEVEL, static_cast<GLint>(texture.levels.size()) - 1);
  constexpr std::array<float, 4> zeros{};
  gl.TexParameterfv(target_, GL_TEXTURE_BORDER_COLOR, zeros.data());
  gl.TexParameteri(target_, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
  gl.TexParameteri(target_, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
  set_filter(context, texture);
  std::size_t numbers = 0;
  for (const std::vector<float>& level : texture.levels) {
    numbers += level.size();
  }
  context.check(fmt::format("making the texture {} of {}x{} texels, {} layers and {} levels ({})", texture.sampler,
                            texture.size.width, texture.size.height, texture.layers, texture.levels.size(),
                            megabytes((texture.half_float ? 2.0 : 4.0) * static_cast<double>(numbers))));
}

Texture::Texture(Context& context, const ShaderWords& words) : Texture(context, GL_TEXTURE_BUFFER) {
  const GlFunctions& gl = context.gl();
  const GLint most = limit(context, GL_MAX_TEXTURE_BUFFER_SIZE);
  if (words.words.empty() || words.words.size() > static_cast<std::size_t>(most)) {
    throw GpuError(fmt::format("{} words in {}: {} takes 1 to {}; take smaller or fewer kernels", words.words.size(),
                               words.sampler, context.info().renderer, most));
  }
  gl.GenBuffers(1, &buffer_);
  gl.BindBuffer(GL_TEXTURE_BUFFER, buffer_);
  const std::size_t bytes = words.words.size() * sizeof(std::uint32_t);
  gl.BufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(bytes), words.words.data(), GL_STATIC_DRAW);
  gl.TexBuffer(GL_TEXTURE_BUFFER, GL_R32UI, buffer_);
  context.check(fmt::format("making the words {} ({})", words.sampler, megabytes(static_cast<double>(bytes))));
}

Texture::Texture(Texture&& other) noexcept
    : context_(other.context_),
      target_(other.target_),
      name_(std::exchange(other.name_, 0)),
      buffer_(std::exchange(other.buffer_, 0)) {}

Texture::~Texture() {
  context_->gl().DeleteTextures(1, &name_);
  context_->gl().DeleteBuffers(1, &buffer_);
}

void Texture::bind(GLuint unit) const {
  context_->gl().ActiveTexture(GL_TEXTURE0 + unit);
  context_->gl().BindTexture(target_, name_);
}

FrameTarget::~FrameTarget() { release(); }

void FrameTarget::release() {
  const GlFunctions& gl = context_.gl();
  gl.DeleteTextures(static_cast<GLsizei>(textures_.size()), textures_.data());
  gl.DeleteFramebuffers(1, &framebuffer_);
  gl.DeleteVertexArrays(1, &vertices_);
  std::ranges::fill(textures_, 0);
  framebuffer_ = vertices_ = 0;
  size_ = {0, 0};
}

void FrameTarget::resize(Extent size) {
  if (size == size_) {
    return;
  }
  require_drawable(context_, size);
  release();
  const GlFunctions& gl = context_.gl();
  framebuffer_ = make_float_framebuffer(context_, size, textures_);
  gl.GenVertexArrays(1, &vertices_);
  const double bytes = 4.0 * sizeof(float) * static_cast<double>(size.area()) * static_cast<double>(textures_.size());
  context_.check(fmt::format("making a frame of {}x{} pixels ({})", size.width, size.height, megabytes(bytes)));
  if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw GpuError(fmt::format("{} does not draw to float32 textures: take another --context, or the processor",
                               context_.info().renderer));
  }
  size_ = size;
}

void FrameTarget::bind(bool as_images) const {
  const GlFunctions& gl = context_.gl();
  if (as_images) {
    for (std::size_t i = 0; i < textures_.size(); ++i) {
      gl.BindImageTexture(static_cast<GLuint>(i), textures_[i], 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA32F);
    }
    return;
  }
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  gl.BindVertexArray(vertices_);
  gl.Viewport(0, 0, size_.width, size_.height);
}

Image FrameTarget::read(int channels) const {
  const GlFunctions& gl = context_.gl();
  Image image(size_, channels);
  std::vector<float> texels(4 * static_cast<std::size_t>(size_.area()));
  for (std::size_t group = 0; group < textures_.size(); ++group) {
    gl.BindTexture(GL_TEXTURE_2D, textures_[group]);
    gl.GetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_FLOAT, texels.data());
    const int first = 4 * static_cast<int>(group);
    for (int c = first; c < std::min(channels, first + 4); ++c) {
      const float* from = texels.data() + (c - first);
      for (int y = 0; y < size_.height; ++y) {
        for (float& v : image.row(c, y)) {
          v = *from;
          from += 4;
        }
      }
    }
  }
  return image;
}

}  // namespace textonbench
