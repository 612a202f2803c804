// The makers of context.cpp's contexts, one a library.
#pragma once

#include <memory>

#include "gpu/context.h"

namespace textonbench {

std::unique_ptr<Context> make_egl_context();
std::unique_ptr<Context> make_glfw_context();
std::unique_ptr<Context> make_osmesa_context();

/// A shared library, which stays open for as long as the program runs: drivers leave threads behind.
class Library {
 public:
  /// The first of the names that opens. Throws GpuError naming the Debian package that has it.
  Library(std::initializer_list<const char*> names, std::string_view package);
  template <class Function>
  Function* function(const char* name) const {
    return reinterpret_cast<Function*>(address(name));
  }

 private:
  /// Throws GpuError for a name that the library has not.
  void* address(const char* name) const;

  std::string name_;
  void* handle_ = nullptr;
};

}  // namespace textonbench
