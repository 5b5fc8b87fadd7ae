// SPDX-License-Identifier: MIT
// Replaces operator new and delete of the program: as those of the standard library, except that large arrays beyond a
// MemoryLimit lie in files.
#include <malloc.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>

#include "app/cli/memory/file_memory.h"
#include "app/cli/memory/memory_limit.h"

namespace {

constexpr std::size_t kUsual = __STDCPP_DEFAULT_NEW_ALIGNMENT__;

void* in_memory(std::size_t bytes, std::size_t alignment) noexcept {
  if (alignment <= kUsual) return std::malloc(bytes > 0 ? bytes : 1);
  return std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
}

void* allocate(std::size_t bytes, std::size_t alignment) {
  if (void* const memory = scarp::cli::beyond_memory_limit(bytes, alignment)) return memory;
  for (;;) {
    if (void* const memory = in_memory(bytes, alignment)) {
      scarp::cli::count_granted(bytes, ::malloc_usable_size(memory));
      return memory;
    }
    const std::new_handler handler = std::get_new_handler();
    if (!handler) {
      scarp::cli::count_granted(bytes, 0);
      throw std::bad_alloc();
    }
    handler();
  }
}

void* allocate_or_null(std::size_t bytes, std::size_t alignment) noexcept {
  try {
    return allocate(bytes, alignment);
  } catch (...) {
    return nullptr;
  }
}

void release(void* memory) noexcept {
  // Memory in files begins with a page; malloc's hardly ever does.
  constexpr std::uintptr_t kLeastPage = 4096;
  if (reinterpret_cast<std::uintptr_t>(memory) % kLeastPage == 0 && scarp::cli::release_in_file(memory)) return;
  if (memory) scarp::cli::count_released(::malloc_usable_size(memory));
  std::free(memory);
}

std::size_t number(std::align_val_t alignment) { return static_cast<std::size_t>(alignment); }

}  // namespace

void* operator new(std::size_t n) { return allocate(n, kUsual); }
void* operator new[](std::size_t n) { return allocate(n, kUsual); }
void* operator new(std::size_t n, std::align_val_t a) { return allocate(n, number(a)); }
void* operator new[](std::size_t n, std::align_val_t a) { return allocate(n, number(a)); }
void* operator new(std::size_t n, const std::nothrow_t&) noexcept { return allocate_or_null(n, kUsual); }
void* operator new[](std::size_t n, const std::nothrow_t&) noexcept { return allocate_or_null(n, kUsual); }
void* operator new(std::size_t n, std::align_val_t a, const std::nothrow_t&) noexcept {
  return allocate_or_null(n, number(a));
}
void* operator new[](std::size_t n, std::align_val_t a, const std::nothrow_t&) noexcept {
  return allocate_or_null(n, number(a));
}
void operator delete(void* p) noexcept { release(p); }
void operator delete[](void* p) noexcept { release(p); }
void operator delete(void* p, std::size_t) noexcept { release(p); }
void operator delete[](void* p, std::size_t) noexcept { release(p); }
void operator delete(void* p, std::align_val_t) noexcept { release(p); }
void operator delete[](void* p, std::align_val_t) noexcept { release(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { release(p); }
void operator delete[](void* p, std::size_t, std::align_val_t) noexcept { release(p); }
void operator delete(void* p, const std::nothrow_t&) noexcept { release(p); }
void operator delete[](void* p, const std::nothrow_t&) noexcept { release(p); }
void operator delete(void* p, std::align_val_t, const std::nothrow_t&) noexcept { release(p); }
void operator delete[](void* p, std::align_val_t, const std::nothrow_t&) noexcept { release(p); }
