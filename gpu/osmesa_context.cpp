#include <array>

#include "gpu/context_kinds.h"

namespace textonbench {
namespace {

// What GL/osmesa.h declares; that header brings an older OpenGL header along.
constexpr int osmesa_format = 0x22;
constexpr int osmesa_profile = 0x33;
constexpr int osmesa_core_profile = 0x34;
constexpr int osmesa_major_version = 0x36;
constexpr int osmesa_minor_version = 0x37;
using CreateContext = void*(const int* attributes, void* shared);
using DestroyContext = void(void* context);
using MakeCurrent = unsigned char(void* context, void* buffer, unsigned type, int width, int height);
using GetProcAddress = void*(const char* name);

class OsmesaContext final : public Context {
 public:
  OsmesaContext()
      : Context(ContextKind::osmesa),
        library_({"libOSMesa.so.8", "libOSMesa.so.6"}, "libosmesa6"),
        make_current_(library_.function<MakeCurrent>("OSMesaMakeCurrent")),
        destroy_(library_.function<DestroyContext>("OSMesaDestroyContext")) {
    constexpr std::array<int, 9> attributes{osmesa_format,
                                            GL_RGBA,
                                            osmesa_profile,
                                            osmesa_core_profile,
                                            osmesa_major_version,
                                            4,
                                            osmesa_minor_version,
                                            1,
                                            0};
    context_ = library_.function<CreateContext>("OSMesaCreateContextAttribs")(attributes.data(), nullptr);
    if (context_ == nullptr) {
      throw GpuError(
          "OSMesa makes no context of OpenGL 4.1, as where Mesa is old or has no LLVM: install a newer libosmesa6");
    }
    try {
      make_current();
      load(library_.function<GetProcAddress>("OSMesaGetProcAddress"));
    } catch (...) {
      destroy_(context_);
      throw;
    }
  }
  OsmesaContext(const OsmesaContext&) = delete;
  OsmesaContext& operator=(const OsmesaContext&) = delete;
  ~OsmesaContext() override { destroy_(context_); }

  void make_current() override {
    if (make_current_(context_, pixels_.data(), GL_UNSIGNED_BYTE, side, side) == 0) {
      throw GpuError("OSMesa does not make its context current");
    }
  }

 private:
  static constexpr int side = 4;  // of the buffer that OSMesa insists on; frames are drawn to textures

  Library library_;
  MakeCurrent* make_current_;
  DestroyContext* destroy_;
  void* context_ = nullptr;
  std::array<unsigned char, std::size_t{4} * side * side> pixels_{};
};

}  // namespace

std::unique_ptr<Context> make_osmesa_context() { return std::make_unique<OsmesaContext>(); }

}  // namespace textonbench
