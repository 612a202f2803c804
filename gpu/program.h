// A linked program and its uniforms.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "gpu/context.h"
#include "gpu/shader_source.h"
#include "methods/base/shader_recipe.h"

namespace textonbench {

/// A shader's stage (GL_FRAGMENT_SHADER, …) and its text.
struct ShaderStage {
  GLenum type;
  ShaderSource source;
};

class Program {
 public:
  /// Throws GpuError with the driver's log, in the files' own lines.
  Program(Context& context, const std::vector<ShaderStage>& stages);
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void use() const { context_.gl().UseProgram(name_); }
  /// Sets a uniform of the program that is in use; one that the compiler has removed is passed over.
  void set(const std::string& uniform, const ShaderValue& value);
  /// Throws GpuError naming the uniforms that are read and were never set, as set by `recipe`.
  void require_all_set(std::string_view recipe) const;

 private:
  Context& context_;
  GLuint name_ = 0;
  std::vector<std::string> unset_;  // active uniforms
};

}  // namespace textonbench
