#include "gpu/context.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "gpu/context_kinds.h"

namespace textonbench {
namespace {

struct NamedKind {
  ContextKind kind;
  std::string_view name;
  std::unique_ptr<Context> (*make)();
};

/// In the order in which they are tried.
constexpr std::array<NamedKind, 3> kinds{{{ContextKind::egl, "egl", make_egl_context},
                                          {ContextKind::osmesa, "osmesa", make_osmesa_context},
                                          {ContextKind::glfw, "glfw", make_glfw_context}}};

const NamedKind& named(ContextKind kind) { return *std::ranges::find(kinds, kind, &NamedKind::kind); }

std::string_view error_name(GLenum error) {
  switch (error) {
    case GL_INVALID_ENUM:
      return "GL_INVALID_ENUM";
    case GL_INVALID_VALUE:
      return "GL_INVALID_VALUE";
    case GL_INVALID_OPERATION:
      return "GL_INVALID_OPERATION";
    case GL_INVALID_FRAMEBUFFER_OPERATION:
      return "GL_INVALID_FRAMEBUFFER_OPERATION";
    case GL_OUT_OF_MEMORY:
      return "GL_OUT_OF_MEMORY (take smaller frames, or texels of 16 bits)";
    case GL_CONTEXT_LOST:
      return "GL_CONTEXT_LOST (the driver was reset: run it again, with smaller frames if it happens again)";
    default:
      return "an unknown error";
  }
}

std::string_view reset_reason(GLenum status) {
  switch (status) {
    case GL_GUILTY_CONTEXT_RESET:
      return "the context is lost by what it was asked for, such as a frame that takes longer than the driver allows "
             "(take smaller frames)";
    case GL_INNOCENT_CONTEXT_RESET:
      return "the context is lost by what another program did (run it again)";
    default:
      return "the context is lost, the driver does not know why (run it again, with smaller frames if it happens "
             "again)";
  }
}

void complain(std::string& complaints, std::string_view text) {
  constexpr std::size_t most = 4000;
  if (complaints.size() < most) {
    complaints += complaints.empty() ? "" : "; ";
    complaints += text;
  }
}

void APIENTRY collect_message(GLenum /*source*/, GLenum type, GLuint /*id*/, GLenum severity, GLsizei /*length*/,
                              const GLchar* message, const void* complaints) {
  const bool is_error = type == GL_DEBUG_TYPE_ERROR || type == GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR;
  const bool is_grave = severity == GL_DEBUG_SEVERITY_HIGH && type != GL_DEBUG_TYPE_PERFORMANCE;
  if (is_error || is_grave) {
    complain(*static_cast<std::string*>(const_cast<void*>(complaints)), message);
  }
}

std::string text_of(const GlFunctions& gl, GLenum which) {
  const GLubyte* text = gl.GetString(which);
  return text == nullptr ? std::string() : reinterpret_cast<const char*>(text);
}

}  // namespace

Library::Library(std::initializer_list<const char*> names, std::string_view package) {
  std::string reasons;
  for (const char* name : names) {
    name_ = name;
    handle_ = dlopen(name, RTLD_NOW | RTLD_LOCAL);
    if (handle_ != nullptr) {
      return;
    }
    complain(reasons, dlerror());
  }
  throw GpuError(fmt::format("{}: install the Debian package {}", reasons, package));
}

void* Library::address(const char* name) const {
  void* found = dlsym(handle_, name);
  if (found == nullptr) {
    throw GpuError(fmt::format("{} has no function {}: it is too old", name_, name));
  }
  return found;
}

void Context::load(const std::function<void*(const char*)>& address_of) {
  gl_.GetString = reinterpret_cast<decltype(gl_.GetString)>(address_of("glGetString"));
  gl_.GetIntegerv = reinterpret_cast<decltype(gl_.GetIntegerv)>(address_of("glGetIntegerv"));
  if (gl_.GetString == nullptr || gl_.GetIntegerv == nullptr) {
    throw GpuError("the driver gives no glGetString: install it anew");
  }
  info_.renderer = text_of(gl_, GL_RENDERER);
  info_.vendor = text_of(gl_, GL_VENDOR);
  info_.version = text_of(gl_, GL_VERSION);
  info_.software = is_software_renderer(info_.renderer);
  gl_.GetIntegerv(GL_MAJOR_VERSION, &info_.major);
  gl_.GetIntegerv(GL_MINOR_VERSION, &info_.minor);
  if (!info_.at_least(4, 1)) {
    throw GpuError(fmt::format("{} has OpenGL {}: expected 4.1 or newer", info_.renderer, info_.version));
  }
  const auto find = [&](auto& function, const char* name) {
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(address_of(name));
    if (function == nullptr) {
      throw GpuError(fmt::format("{} has OpenGL {} but gives no function {}: install its driver anew", info_.renderer,
                                 info_.version, name));
    }
  };
#define TEXTONBENCH_FIND(name) find(gl_.name, "gl" #name);
  TEXTONBENCH_GL_FUNCTIONS(TEXTONBENCH_FIND)
  if (info_.compute()) {
    TEXTONBENCH_NEW_GL_FUNCTIONS(TEXTONBENCH_FIND)
    gl_.Enable(GL_DEBUG_OUTPUT);
    gl_.Enable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    gl_.DebugMessageCallback(collect_message, &complaints_);
  }
  if (info_.at_least(4, 5)) {
    TEXTONBENCH_NEWEST_GL_FUNCTIONS(TEXTONBENCH_FIND)
  }
#undef TEXTONBENCH_FIND
}

void Context::collect_errors() {
  const GLenum reset = gl_.GetGraphicsResetStatus == nullptr ? GL_NO_ERROR : gl_.GetGraphicsResetStatus();
  if (reset != GL_NO_ERROR) {
    complain(complaints_, reset_reason(reset));
  }
  constexpr int most = 16;  // a lost context gives errors without end
  for (int i = 0; i < most; ++i) {
    const GLenum error = gl_.GetError();
    if (error == GL_NO_ERROR || (error == GL_CONTEXT_LOST && reset != GL_NO_ERROR)) {
      break;
    }
    complain(complaints_, error_name(error));
    if (error == GL_CONTEXT_LOST) {
      break;
    }
  }
}

void Context::forget_complaints() {
  collect_errors();
  complaints_.clear();
}

void Context::check(std::string_view doing) {
  collect_errors();
  if (!complaints_.empty()) {
    std::string complaints;
    complaints.swap(complaints_);
    throw GpuError(fmt::format("{} on {}: {}", doing, info_.renderer, complaints));
  }
}

std::unique_ptr<Context> make_context(ContextKind kind) { return named(kind).make(); }

std::unique_ptr<Context> make_context() {
  std::string reasons;
  for (const NamedKind& it : kinds) {
    try {
      return it.make();
    } catch (const GpuError& error) {
      reasons += fmt::format("  {}: {}\n", it.name, error.what());
    }
  }
  throw GpuError(
      fmt::format("no OpenGL here:\n{}Do what one of these says; textonbench synth without --renderer gpu "
                  "draws the same on the processor and needs none of them",
                  reasons));
}

std::string_view context_name(ContextKind kind) { return named(kind).name; }

ContextKind context_kind(std::string_view name) {
  const auto* found = std::ranges::find(kinds, name, &NamedKind::name);
  if (found == kinds.end()) {
    throw std::invalid_argument(fmt::format("context '{}': expected egl, osmesa or glfw", name));
  }
  return found->kind;
}

bool is_software_renderer(std::string_view renderer) {
  std::string lower(renderer);
  std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  constexpr std::array<std::string_view, 7> software{"llvmpipe", "lavapipe",    "softpipe", "swrast",
                                                     "swr",      "swiftshader", "software"};
  return std::ranges::any_of(software, [&](std::string_view s) { return lower.find(s) != std::string::npos; });
}

}  // namespace textonbench
