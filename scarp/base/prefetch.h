// SPDX-License-Identifier: MIT
// Memory that is asked for before it is written. The rows of a large array lie pages apart: no processor guesses the
// next one, and each begins with a walk through the page tables.
#pragma once

namespace scarp {

/// Asks for `count` values from `values` on; they need not exist.
template <class T>
void prefetch_for_write(const T* values, int count) {
  constexpr int kPerLine = 64 / sizeof(T);
  for (int i = 0; i < count; i += kPerLine) __builtin_prefetch(values + i, 1);
}

}  // namespace scarp
