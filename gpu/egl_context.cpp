#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "gpu/context_kinds.h"

namespace textonbench {
namespace {

bool lists_extension(const char* extensions, std::string_view wanted) {
  const std::string text = fmt::format(" {} ", extensions == nullptr ? "" : extensions);
  return text.find(fmt::format(" {} ", wanted)) != std::string::npos;
}

std::string error_text(EGLint code) {
  constexpr std::array<std::string_view, 15> names{
      "no error told",     "EGL_NOT_INITIALIZED", "EGL_BAD_ACCESS",        "EGL_BAD_ALLOC",
      "EGL_BAD_ATTRIBUTE", "EGL_BAD_CONFIG",      "EGL_BAD_CONTEXT",       "EGL_BAD_CURRENT_SURFACE",
      "EGL_BAD_DISPLAY",   "EGL_BAD_MATCH",       "EGL_BAD_NATIVE_PIXMAP", "EGL_BAD_NATIVE_WINDOW",
      "EGL_BAD_PARAMETER", "EGL_BAD_SURFACE",     "EGL_CONTEXT_LOST"};
  const auto index = static_cast<std::size_t>(code - EGL_SUCCESS);
  return index < names.size() ? std::string(names[index]) : fmt::format("EGL error {:#x}", static_cast<unsigned>(code));
}

/// What is called of EGL.
struct EglFunctions {
  explicit EglFunctions(const Library& library)
      : get_proc_address(library.function<decltype(eglGetProcAddress)>("eglGetProcAddress")),
        query_string(library.function<decltype(eglQueryString)>("eglQueryString")),
        get_display(library.function<decltype(eglGetDisplay)>("eglGetDisplay")),
        get_error(library.function<decltype(eglGetError)>("eglGetError")),
        initialize(library.function<decltype(eglInitialize)>("eglInitialize")),
        terminate(library.function<decltype(eglTerminate)>("eglTerminate")),
        bind_api(library.function<decltype(eglBindAPI)>("eglBindAPI")),
        choose_config(library.function<decltype(eglChooseConfig)>("eglChooseConfig")),
        create_pbuffer(library.function<decltype(eglCreatePbufferSurface)>("eglCreatePbufferSurface")),
        destroy_surface(library.function<decltype(eglDestroySurface)>("eglDestroySurface")),
        create_context(library.function<decltype(eglCreateContext)>("eglCreateContext")),
        destroy_context(library.function<decltype(eglDestroyContext)>("eglDestroyContext")),
        make_current(library.function<decltype(eglMakeCurrent)>("eglMakeCurrent")) {}

  template <class Function>
  Function extension(const char* name) const {
    return reinterpret_cast<Function>(get_proc_address(name));
  }

  decltype(eglGetProcAddress)* get_proc_address;
  decltype(eglQueryString)* query_string;
  decltype(eglGetDisplay)* get_display;
  decltype(eglGetError)* get_error;
  decltype(eglInitialize)* initialize;
  decltype(eglTerminate)* terminate;
  decltype(eglBindAPI)* bind_api;
  decltype(eglChooseConfig)* choose_config;
  decltype(eglCreatePbufferSurface)* create_pbuffer;
  decltype(eglDestroySurface)* destroy_surface;
  decltype(eglCreateContext)* create_context;
  decltype(eglDestroyContext)* destroy_context;
  decltype(eglMakeCurrent)* make_current;
};

struct NamedDisplay {
  std::string name;
  EGLDisplay display;
};

/// Devices first, those that are no software before the others, then Mesa without a surface, then the default.
std::vector<NamedDisplay> displays(const EglFunctions& egl) {
  std::vector<NamedDisplay> found;
  const char* client = egl.query_string(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  const auto platform_display = egl.extension<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
  const auto query_devices = egl.extension<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
  const auto query_device = egl.extension<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
  const bool has_devices = lists_extension(client, "EGL_EXT_platform_device") && query_devices != nullptr &&
                           query_device != nullptr && platform_display != nullptr;
  std::array<EGLDeviceEXT, 64> devices{};
  EGLint count = 0;
  if (has_devices && query_devices(static_cast<EGLint>(devices.size()), devices.data(), &count) == EGL_TRUE) {
    for (const bool wants_software : {false, true}) {
      for (int i = 0; i < count; ++i) {
        const EGLDeviceEXT device = devices[static_cast<std::size_t>(i)];
        if (lists_extension(query_device(device, EGL_EXTENSIONS), "EGL_MESA_device_software") == wants_software) {
          found.push_back({fmt::format("device {}", i), platform_display(EGL_PLATFORM_DEVICE_EXT, device, nullptr)});
        }
      }
    }
  }
  if (lists_extension(client, "EGL_MESA_platform_surfaceless") && platform_display != nullptr) {
    found.push_back({"surfaceless", platform_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr)});
  }
  found.push_back({"default display", egl.get_display(EGL_DEFAULT_DISPLAY)});
  std::erase_if(found, [](const NamedDisplay& it) { return it.display == EGL_NO_DISPLAY; });
  return found;
}

class EglContext final : public Context {
 public:
  EglContext() : Context(ContextKind::egl), library_({"libEGL.so.1"}, "libegl1"), egl_(library_) {
    std::vector<std::string> reasons;
    for (const NamedDisplay& candidate : displays(egl_)) {
      std::string reason = open(candidate.display);
      if (reason.empty()) {
        return;
      }
      reasons.push_back(fmt::format("{}: {}", candidate.name, reason));
    }
    throw GpuError(
        fmt::format("EGL has no device with OpenGL 4.1 ({}): install the driver of the graphics processor with its EGL "
                    "library, or Mesa's (Debian packages libegl-mesa0 and libgl1-mesa-dri); --context osmesa does "
                    "without EGL",
                    reasons.empty() ? "none at all" : fmt::format("{}", fmt::join(reasons, "; "))));
  }
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;
  ~EglContext() override { close(); }

  void make_current() override {
    egl_.bind_api(EGL_OPENGL_API);
    if (egl_.make_current(display_, surface_, surface_, context_) != EGL_TRUE) {
      throw GpuError(fmt::format("EGL does not make its context current: {}", error_text(egl_.get_error())));
    }
  }

 private:
  /// A reason why not, or nothing.
  std::string open(EGLDisplay display) {
    display_ = display;
    if (egl_.initialize(display_, nullptr, nullptr) != EGL_TRUE) {
      return "does not start: " + error_text(egl_.get_error());
    }
    std::string reason = create();
    if (reason.empty()) {
      try {
        make_current();
        load([this](const char* name) { return reinterpret_cast<void*>(egl_.get_proc_address(name)); });
        return {};
      } catch (const GpuError& error) {
        reason = error.what();
      }
    }
    close();
    return reason;
  }

  std::string create() {
    if (egl_.bind_api(EGL_OPENGL_API) != EGL_TRUE) {
      return "knows no OpenGL";
    }
    const char* extensions = egl_.query_string(display_, EGL_EXTENSIONS);
    EGLConfig config = EGL_NO_CONFIG_KHR;
    const bool is_surfaceless = lists_extension(extensions, "EGL_KHR_surfaceless_context");
    if (!is_surfaceless || !lists_extension(extensions, "EGL_KHR_no_config_context")) {
      constexpr std::array<EGLint, 5> wanted{EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                                             EGL_NONE};
      EGLint count = 0;
      if (egl_.choose_config(display_, wanted.data(), &config, 1, &count) != EGL_TRUE || count == 0) {
        return "no configuration with OpenGL";
      }
    }
    for (const auto& [major, minor] : {std::pair{4, 6}, {4, 5}, {4, 4}, {4, 3}, {4, 2}, {4, 1}, {3, 3}}) {
      // Not every driver can tell when it was reset.
      if (create_version(config, major, minor, true) || create_version(config, major, minor, false)) {
        break;
      }
    }
    if (context_ == EGL_NO_CONTEXT) {
      return "no context of OpenGL: " + error_text(egl_.get_error());
    }
    if (!is_surfaceless) {
      constexpr std::array<EGLint, 5> size{EGL_WIDTH, 1, EGL_HEIGHT, 1, EGL_NONE};
      surface_ = egl_.create_pbuffer(display_, config, size.data());
      if (surface_ == EGL_NO_SURFACE) {
        return "no surface: " + error_text(egl_.get_error());
      }
    }
    return {};
  }

  bool create_version(EGLConfig config, EGLint major, EGLint minor, bool tells_resets) {
    std::vector<EGLint> attributes{EGL_CONTEXT_MAJOR_VERSION,       major,
                                   EGL_CONTEXT_MINOR_VERSION,       minor,
                                   EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                   EGL_CONTEXT_OPENGL_DEBUG,        EGL_TRUE};
    if (tells_resets) {
      attributes.insert(attributes.end(), {EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY, EGL_LOSE_CONTEXT_ON_RESET});
    }
    attributes.push_back(EGL_NONE);
    context_ = egl_.create_context(display_, config, EGL_NO_CONTEXT, attributes.data());
    return context_ != EGL_NO_CONTEXT;
  }

  /// The display stays open: another context of this program may use it, and EGL counts no users.
  void close() {
    if (context_ != EGL_NO_CONTEXT) {
      egl_.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
      egl_.destroy_context(display_, context_);
      context_ = EGL_NO_CONTEXT;
    }
    if (surface_ != EGL_NO_SURFACE) {
      egl_.destroy_surface(display_, surface_);
      surface_ = EGL_NO_SURFACE;
    }
  }

  Library library_;
  EglFunctions egl_;
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLSurface surface_ = EGL_NO_SURFACE;
  EGLContext context_ = EGL_NO_CONTEXT;
};

}  // namespace

std::unique_ptr<Context> make_egl_context() { return std::make_unique<EglContext>(); }

}  // namespace textonbench
