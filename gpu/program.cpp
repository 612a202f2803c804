#include "gpu/program.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

namespace textonbench {
namespace {

std::string_view stage_name(GLenum type) {
  return type == GL_VERTEX_SHADER ? "vertex" : type == GL_FRAGMENT_SHADER ? "fragment" : "compute";
}

std::string shader_log(const GlFunctions& gl, GLuint shader) {
  GLint length = 0;
  gl.GetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
  gl.GetShaderInfoLog(shader, length, nullptr, log.data());
  log.pop_back();  // the closing zero
  return log;
}

std::string program_log(const GlFunctions& gl, GLuint program) {
  GLint length = 0;
  gl.GetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
  gl.GetProgramInfoLog(program, length, nullptr, log.data());
  log.pop_back();  // the closing zero
  return log;
}

void compile(const GlFunctions& gl, GLuint program, const ShaderStage& stage) {
  const GLuint shader = gl.CreateShader(stage.type);
  const char* text = stage.source.text.c_str();
  gl.ShaderSource(shader, 1, &text, nullptr);
  gl.CompileShader(shader);
  gl.AttachShader(program, shader);
  GLint compiled = GL_FALSE;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  const std::string log = compiled == GL_TRUE ? std::string() : shader_log(gl, shader);
  gl.DeleteShader(shader);  // the program keeps it
  if (compiled != GL_TRUE) {
    throw GpuError(
        fmt::format("the {} shader does not compile:\n{}", stage_name(stage.type), stage.source.readable(log)));
  }
}

struct SetUniform {
  const GlFunctions& gl;
  GLint place;

  void operator()(std::int32_t v) const { gl.Uniform1i(place, v); }
  void operator()(std::uint32_t v) const { gl.Uniform1ui(place, v); }
  void operator()(float v) const { gl.Uniform1f(place, v); }
  void operator()(const std::array<std::int32_t, 2>& v) const { gl.Uniform2i(place, v[0], v[1]); }
  void operator()(const std::array<float, 2>& v) const { gl.Uniform2f(place, v[0], v[1]); }
  void operator()(const std::array<float, 4>& v) const { gl.Uniform4f(place, v[0], v[1], v[2], v[3]); }
  void operator()(const std::array<std::uint32_t, 2>& v) const { gl.Uniform2ui(place, v[0], v[1]); }
  void operator()(const std::array<std::uint32_t, 4>& v) const { gl.Uniform4ui(place, v[0], v[1], v[2], v[3]); }
  void operator()(const std::vector<float>& v) const { gl.Uniform1fv(place, static_cast<GLsizei>(v.size()), v.data()); }
};

}  // namespace

Program::Program(Context& context, const std::vector<ShaderStage>& stages) : context_(context) {
  const GlFunctions& gl = context.gl();
  name_ = gl.CreateProgram();
  try {
    for (const ShaderStage& stage : stages) {
      compile(gl, name_, stage);
    }
    gl.LinkProgram(name_);
    GLint linked = GL_FALSE;
    gl.GetProgramiv(name_, GL_LINK_STATUS, &linked);
    if (linked != GL_TRUE) {
      throw GpuError(fmt::format("the shaders do not link:\n{}", program_log(gl, name_)));
    }
  } catch (...) {
    context.forget_complaints();  // the log says more
    gl.DeleteProgram(name_);
    throw;
  }
  GLint uniforms = 0;
  gl.GetProgramiv(name_, GL_ACTIVE_UNIFORMS, &uniforms);
  for (GLint i = 0; i < uniforms; ++i) {
    std::array<char, 256> text{};
    GLint size = 0;
    GLenum type = 0;
    gl.GetActiveUniform(name_, static_cast<GLuint>(i), static_cast<GLsizei>(text.size()), nullptr, &size, &type,
                        text.data());
    const std::string_view uniform = text.data();
    unset_.emplace_back(uniform.substr(0, uniform.find('[')));
  }
}

Program::~Program() { context_.gl().DeleteProgram(name_); }

void Program::set(const std::string& uniform, const ShaderValue& value) {
  const GLint place = context_.gl().GetUniformLocation(name_, uniform.c_str());
  if (place >= 0) {
    std::visit(SetUniform{context_.gl(), place}, value);
  }
  std::erase(unset_, uniform);
}

void Program::require_all_set(std::string_view recipe) const {
  if (!unset_.empty()) {
    throw GpuError(fmt::format(
        "the recipe of {} does not set what its shader reads: {}; add it to its uniforms, textures or words", recipe,
        fmt::join(unset_, ", ")));
  }
}

}  // namespace textonbench
