// SPDX-License-Identifier: MIT
// Counts the allocations of this thread: malloc and all others of the C library, which C++'s `new` and the shared
// libraries call too. Include it in one file of a program; sanitizers have their own malloc.
#pragma once

#include <cerrno>
#include <cstddef>

extern "C" {
// glibc's own names of what this program replaces.
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
}

namespace scarp::test {
inline thread_local long allocations = 0;
}

extern "C" {
void* malloc(std::size_t size) noexcept {
  ++scarp::test::allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) noexcept {
  ++scarp::test::allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) noexcept {
  ++scarp::test::allocations;
  return __libc_realloc(memory, size);
}
void* memalign(std::size_t alignment, std::size_t size) noexcept {
  ++scarp::test::allocations;
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept { return memalign(alignment, size); }
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept {
  *memory = memalign(alignment, size);
  return *memory ? 0 : ENOMEM;
}
}

namespace scarp::test {

/// Returns how often `call` allocates.
template <class Call>
long allocations_of(const Call& call) {
  const long before = allocations;
  call();
  return allocations - before;
}

}  // namespace scarp::test
