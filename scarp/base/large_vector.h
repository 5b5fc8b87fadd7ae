// SPDX-License-Identifier: MIT
// Vectors for large arrays that are read at distant places: in memory that the system may map by large pages, so that
// processors find addresses without walking page tables. Linux: MADV_HUGEPAGE; elsewhere ordinary memory.
#pragma once

#ifdef __linux__
#include <sys/mman.h>
#endif

#include <cstddef>
#include <limits>
#include <new>
#include <vector>

namespace scarp {

template <class T>
struct LargePageAllocator {
  using value_type = T;

  LargePageAllocator() = default;
  template <class U>
  LargePageAllocator(const LargePageAllocator<U>&) {}

  T* allocate(std::size_t count) {
    if (count > std::numeric_limits<std::size_t>::max() / sizeof(T) - kPage) throw std::bad_array_new_length();
    const std::size_t bytes = count * sizeof(T);
    if (bytes < kLeast) return static_cast<T*>(::operator new(bytes));
    void* const memory = ::operator new(bytes, std::align_val_t(kPage));
#ifdef MADV_HUGEPAGE
    // Whole pages; a system without them refuses, which changes nothing but the speed.
    ::madvise(memory, bytes / kPage * kPage, MADV_HUGEPAGE);
#endif
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t count) {
    if (count * sizeof(T) < kLeast) return ::operator delete(memory);
    ::operator delete(memory, std::align_val_t(kPage));
  }

  bool operator==(const LargePageAllocator&) const { return true; }

 private:
  static constexpr std::size_t kPage = std::size_t{2} << 20, kLeast = 2 * kPage;
};

template <class T>
using LargeVector = std::vector<T, LargePageAllocator<T>>;

}  // namespace scarp
