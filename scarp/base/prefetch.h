// SPDX-License-Identifier: MIT
// Prefetching for writes. The rows of a large array lie pages apart: hardware prefetchers do not predict the next row,
// and each row starts with a page-table walk.
#pragma once

namespace scarp {

/// Prefetches `count` values for writing. The addresses need not be valid.
template <class T>
void prefetch_for_write(const T* values, int count) {
  constexpr int kPerLine = 64 / sizeof(T);
  for (int i = 0; i < count; i += kPerLine) __builtin_prefetch(values + i, 1);
}

}  // namespace scarp
