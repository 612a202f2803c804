#include "methods/base/aligned_buffer.h"

#include <sys/mman.h>

#include <cstdlib>
#include <new>

namespace textonbench {

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
  void* memory = std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
  if (memory == nullptr) {
    throw std::bad_alloc();
  }
  if (large) {
    madvise(memory, bytes, MADV_HUGEPAGE);  // a hint: refusal only costs speed
  }
  return memory;
}

void free_aligned(void* memory) { std::free(memory); }

}  // namespace textonbench
