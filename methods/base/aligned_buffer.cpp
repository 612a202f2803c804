#include "methods/base/aligned_buffer.h"

#include <sys/mman.h>
#include <tbb/scalable_allocator.h>

#include <cstdlib>
#include <new>

namespace textonbench {
namespace {

// The address sanitizer sees only what the C library's allocator gives.
#ifdef __SANITIZE_ADDRESS__
void* allocate(std::size_t bytes, std::size_t alignment) {
  return std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
}
void release(void* memory) { std::free(memory); }
#else
void* allocate(std::size_t bytes, std::size_t alignment) { return scalable_aligned_malloc(bytes, alignment); }
void release(void* memory) { scalable_aligned_free(memory); }
#endif

}  // namespace

void* allocate_aligned(std::size_t bytes) {
  constexpr std::size_t huge_page = std::size_t{2} << 20;
  const bool large = bytes >= 2 * huge_page;
  const std::size_t alignment = large ? huge_page : 64;
  if (bytes == 0) {
    return nullptr;
  }
  if (bytes > PTRDIFF_MAX - alignment) {
    throw std::bad_alloc();
  }
  void* memory = allocate(bytes, alignment);
  if (memory == nullptr) {
    throw std::bad_alloc();
  }
  if (large) {
    madvise(memory, bytes, MADV_HUGEPAGE);  // a hint: refusal only costs speed
  }
  return memory;
}

void free_aligned(void* memory) { release(memory); }

}  // namespace textonbench
