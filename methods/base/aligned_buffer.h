// Memory for rasters and spectra.
#pragma once

#include <cstddef>
#include <cstring>
#include <memory>
#include <utility>

namespace textonbench {

/// 64-byte aligned memory; blocks of 4 MiB and more are aligned for, and ask for, huge pages, which spares most of the
/// page faults of a first touch. TBB's allocator keeps some freed blocks for the next of their size: clearing fresh
/// pages takes longer than the noise of a few impacts on them. Throws std::bad_alloc.
void* allocate_aligned(std::size_t bytes);
void free_aligned(void* memory);

/// Owning array of trivially copyable T with deep copies. Not initialised: its owner fills it.
template <class T>
class AlignedBuffer {
 public:
  AlignedBuffer() = default;
  explicit AlignedBuffer(std::size_t size) : size_(size), data_(static_cast<T*>(allocate_aligned(size * sizeof(T)))) {}
  AlignedBuffer(const AlignedBuffer& other) : AlignedBuffer(other.size_) {
    if (size_ > 0) {
      std::memcpy(static_cast<void*>(data_.get()), other.data_.get(), bytes());
    }
  }
  AlignedBuffer& operator=(const AlignedBuffer& other) {
    if (this != &other) {
      *this = AlignedBuffer(other);
    }
    return *this;
  }
  AlignedBuffer(AlignedBuffer&& other) noexcept : size_(std::exchange(other.size_, 0)), data_(std::move(other.data_)) {}
  AlignedBuffer& operator=(AlignedBuffer&& other) noexcept {
    size_ = std::exchange(other.size_, 0);
    data_ = std::move(other.data_);
    return *this;
  }
  ~AlignedBuffer() = default;

  T* data() const { return data_.get(); }
  std::size_t size() const { return size_; }
  std::size_t bytes() const { return size_ * sizeof(T); }
  void set_zero() { std::memset(static_cast<void*>(data_.get()), 0, bytes()); }

 private:
  struct Free {
    void operator()(T* p) const { free_aligned(p); }
  };
  std::size_t size_ = 0;
  std::unique_ptr<T, Free> data_;
};

}  // namespace textonbench
