#pragma once
// Arrays of millions of records that live only while the world is built, in pages straight from the system: a
// page costs memory only once it is written to, and can be given back while the rest is in use.

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <new>
#include <type_traits>
#include <utility>

namespace lambent {

template <class T> class Pages {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  /// Room for `capacity` records, none of them written yet.
  explicit Pages(std::size_t capacity) : capacity_(capacity) {
    if (capacity == 0) return;
    void* memory = ::mmap(nullptr, capacity * sizeof(T), PROT_READ | PROT_WRITE,
                          MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (memory == MAP_FAILED) throw std::bad_alloc();
    data_ = static_cast<T*>(memory);
  }
  Pages(Pages&& other) noexcept
      : data_(std::exchange(other.data_, nullptr)),
        capacity_(std::exchange(other.capacity_, 0)),
        size_(std::exchange(other.size_, 0)) {}
  Pages& operator=(Pages&&) = delete;
  ~Pages() {
    if (data_) ::munmap(data_, capacity_ * sizeof(T));
  }

  /// There must be room for it.
  void push_back(const T& value) { new (data_ + size_++) T(value); }

  /// How many records it pays to give back at once: 64 KiB of them.
  static constexpr std::size_t step = (std::size_t(1) << 16) / sizeof(T);
  /// The records from `first` up to `end`, that one not included, are not wanted any more.
  void give_back(std::size_t first, std::size_t end) {
    const auto page = std::uintptr_t(::sysconf(_SC_PAGESIZE));
    const auto from = (std::uintptr_t(data_ + first) + page - 1) / page * page,
               to = std::uintptr_t(data_ + end) / page * page;
    if (from < to) ::madvise(reinterpret_cast<void*>(from), to - from, MADV_DONTNEED);
  }

  T* data() { return data_; }
  T* begin() { return data_; }
  T* end() { return data_ + size_; }
  T& operator[](std::size_t i) { return data_[i]; }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }

 private:
  T* data_ = nullptr;
  std::size_t capacity_ = 0, size_ = 0;
};

}  // namespace lambent
