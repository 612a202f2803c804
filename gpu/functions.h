// The OpenGL functions that are used, as the current context gives them: loaders that look at a library's names instead
// fail under OSMesa.
#pragma once

#define GL_GLEXT_PROTOTYPES  // declarations alone: their types are taken below
#include <GL/glcorearb.h>

namespace textonbench {

// clang-format off
#define TEXTONBENCH_GL_FUNCTIONS(X)                                                                                    \
  X(ActiveTexture) X(AttachShader) X(BeginQuery) X(BindBuffer) X(BindFramebuffer) X(BindRenderbuffer) X(BindTexture)   \
  X(BindVertexArray) X(BlendFunc) X(BufferData) X(CheckFramebufferStatus) X(ClearBufferfv) X(CompileShader)            \
  X(CreateProgram) X(CreateShader) X(DeleteBuffers) X(DeleteFramebuffers) X(DeleteProgram) X(DeleteQueries)            \
  X(DeleteRenderbuffers) X(DeleteShader) X(DeleteTextures) X(DeleteVertexArrays) X(Disable) X(DrawArrays)              \
  X(DrawBuffers) X(DrawElements) X(Enable) X(EnableVertexAttribArray) X(EndQuery) X(Finish)                            \
  X(FramebufferRenderbuffer) X(FramebufferTexture2D) X(GenBuffers) X(GenFramebuffers) X(GenQueries)                    \
  X(GenRenderbuffers) X(GenTextures) X(GenVertexArrays) X(GetActiveUniform) X(GetError) X(GetFloatv) X(GetIntegerv)    \
  X(GetProgramInfoLog) X(GetProgramiv) X(GetQueryObjectui64v) X(GetShaderInfoLog) X(GetShaderiv) X(GetString)          \
  X(GetStringi) X(GetTexImage) X(GetUniformLocation) X(LinkProgram) X(PixelStorei) X(RenderbufferStorage)              \
  X(ShaderSource) X(TexBuffer) X(TexImage2D) X(TexImage3D) X(TexParameterf) X(TexParameterfv) X(TexParameteri)         \
  X(Uniform1f) X(Uniform1fv) X(Uniform1i) X(Uniform1ui) X(Uniform2f) X(Uniform2i) X(Uniform2ui) X(Uniform4f)           \
  X(Uniform4ui) X(UseProgram) X(VertexAttribPointer) X(Viewport)
// clang-format on

/// Of OpenGL 4.3 and newer; null before.
#define TEXTONBENCH_NEW_GL_FUNCTIONS(X) X(BindImageTexture) X(DebugMessageCallback) X(DispatchCompute) X(MemoryBarrier)

/// Of OpenGL 4.5 and newer; null before.
#define TEXTONBENCH_NEWEST_GL_FUNCTIONS(X) X(GetGraphicsResetStatus)

struct GlFunctions {
#define TEXTONBENCH_MEMBER(name) decltype(&gl##name) name = nullptr;  // NOLINT(bugprone-macro-parentheses)
  TEXTONBENCH_GL_FUNCTIONS(TEXTONBENCH_MEMBER)
  TEXTONBENCH_NEW_GL_FUNCTIONS(TEXTONBENCH_MEMBER)
  TEXTONBENCH_NEWEST_GL_FUNCTIONS(TEXTONBENCH_MEMBER)
#undef TEXTONBENCH_MEMBER
};

}  // namespace textonbench
