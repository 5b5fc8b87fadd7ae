// SPDX-License-Identifier: MIT
// Prefetching. The rows of a large array lie pages apart: hardware prefetchers do not predict the next row,
// and each row starts with a page-table walk.
#pragma once

#ifdef _MSC_VER
#include <intrin.h>
#endif

namespace scarp {

/// Prefetches a cache line for reading. The address need not be valid.
inline void prefetch(const void* address) {
#if defined(__GNUC__)
  __builtin_prefetch(address);
#elif defined(_M_X64)
  _mm_prefetch(static_cast<const char*>(address), _MM_HINT_T0);
#else
  static_cast<void>(address);
#endif
}

/// The same for writing.
inline void prefetch_for_write(const void* address) {
#if defined(__GNUC__)
  __builtin_prefetch(address, 1);
#else
  prefetch(address);
#endif
}

/// Prefetches `count` values for writing. The addresses need not be valid.
template <class T>
void prefetch_for_write(const T* values, int count) {
  constexpr int kPerLine = 64 / sizeof(T);
  for (int i = 0; i < count; i += kPerLine) prefetch_for_write(values + i);
}

}  // namespace scarp
