// An OpenGL context without a window on the screen, on a graphics processor or in software.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "gpu/functions.h"

namespace textonbench {

/// egl: no display at all; the first device of NVIDIA's or another driver that gives a context, then Mesa's surfaceless
/// platform. glfw: a hidden window on the display. osmesa: Mesa's software in memory.
enum class ContextKind { egl, glfw, osmesa };

/// What the driver says of itself.
struct ContextInfo {
  ContextKind kind = ContextKind::egl;
  std::string renderer;
  std::string vendor;
  std::string version;
  int major = 0;
  int minor = 0;
  /// Whether the renderer is llvmpipe, softpipe or another one that runs on the processor: its frame rates are no
  /// graphics processor's.
  bool software = false;
  bool at_least(int wanted_major, int wanted_minor) const {
    return major > wanted_major || (major == wanted_major && minor >= wanted_minor);
  }
  bool compute() const { return at_least(4, 3); }
};

/// A library, display, driver or shader that cannot serve. Its text says what to do.
class GpuError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Owns a context; everything made with it must be gone before it. It is used by the thread that made it.
class Context {
 public:
  virtual ~Context() = default;
  virtual void make_current() = 0;

  const GlFunctions& gl() const { return gl_; }
  const ContextInfo& info() const { return info_; }

  /// Throws GpuError with what the driver has complained of since the last call: errors of OpenGL, a lost context, and
  /// high-severity messages of its debug output. `doing` is for the message: "drawing a frame".
  void check(std::string_view doing);
  /// Drops those complaints, for a caller that tells them in other words.
  void forget_complaints();

 protected:
  explicit Context(ContextKind kind) { info_.kind = kind; }
  /// Fills the table and the description, and turns the debug output on. Throws GpuError for less than OpenGL 4.1.
  void load(const std::function<void*(const char*)>& address_of);

  GlFunctions gl_{};
  ContextInfo info_;

 private:
  /// Asks the driver, and adds to complaints_ what it tells.
  void collect_errors();

  std::string complaints_;
};

/// Throws GpuError naming what is missing: the library, the display, the device or the version.
std::unique_ptr<Context> make_context(ContextKind kind);

/// The first of egl, osmesa, glfw that can be made: a graphics processor where there is one, else software. Throws
/// GpuError with the reasons of all three.
std::unique_ptr<Context> make_context();

std::string_view context_name(ContextKind kind);
/// Throws std::invalid_argument listing the names for another one.
ContextKind context_kind(std::string_view name);

/// Whether a renderer's string is that of software.
bool is_software_renderer(std::string_view renderer);

}  // namespace textonbench
