#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include "gpu/context_kinds.h"

namespace textonbench {
namespace {

class GlfwContext final : public Context {
 public:
  GlfwContext()
      : Context(ContextKind::glfw),
        library_({"libglfw.so.3"}, "libglfw3"),
        make_current_(library_.function<decltype(glfwMakeContextCurrent)>("glfwMakeContextCurrent")),
        destroy_window_(library_.function<decltype(glfwDestroyWindow)>("glfwDestroyWindow")) {
    if (library_.function<decltype(glfwInit)>("glfwInit")() == GLFW_FALSE) {
      throw GpuError(fmt::format("GLFW finds no display: {}; --context egl and --context osmesa need none", reason()));
    }
    const auto hint = library_.function<decltype(glfwWindowHint)>("glfwWindowHint");
    hint(GLFW_VISIBLE, GLFW_FALSE);
    hint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    hint(GLFW_CONTEXT_VERSION_MINOR, 1);
    hint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    hint(GLFW_OPENGL_DEBUG_CONTEXT, GLFW_TRUE);
    hint(GLFW_CONTEXT_ROBUSTNESS, GLFW_LOSE_CONTEXT_ON_RESET);  // where there is such a thing
    window_ =
        library_.function<decltype(glfwCreateWindow)>("glfwCreateWindow")(16, 16, "textonbench", nullptr, nullptr);
    if (window_ == nullptr) {
      throw GpuError(fmt::format(
          "GLFW makes no window with OpenGL 4.1: {}; --context egl and --context osmesa need no display", reason()));
    }
    try {
      make_current();
      const auto address = library_.function<decltype(glfwGetProcAddress)>("glfwGetProcAddress");
      load([address](const char* name) { return reinterpret_cast<void*>(address(name)); });
    } catch (...) {
      close();
      throw;
    }
  }
  GlfwContext(const GlfwContext&) = delete;
  GlfwContext& operator=(const GlfwContext&) = delete;
  ~GlfwContext() override { close(); }

  void make_current() override { make_current_(window_); }

 private:
  std::string reason() const {
    const char* text = nullptr;
    library_.function<decltype(glfwGetError)>("glfwGetError")(&text);
    return text == nullptr ? "no reason given" : text;
  }
  /// GLFW stays started: terminating it would destroy the windows of this program's other contexts too.
  void close() { destroy_window_(window_); }

  Library library_;
  decltype(glfwMakeContextCurrent)* make_current_;
  decltype(glfwDestroyWindow)* destroy_window_;
  GLFWwindow* window_ = nullptr;
};

}  // namespace

std::unique_ptr<Context> make_glfw_context() { return std::make_unique<GlfwContext>(); }

}  // namespace textonbench
