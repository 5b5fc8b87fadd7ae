// SPDX-License-Identifier: MIT
// Vector memory that each thread keeps from one task to the next. Allocators return large blocks to the system; a loop
// over tiles of a picture that allocates its vectors for each tile spends most of its time in page faults.
//
//   struct Task {
//     Task() { borrow(rays); }        // empty, with the capacity that the last task on this thread left
//     ~Task() { keep(rays); }
//     std::vector<Ray> rays;
//   };
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace scarp {

/// Whether threads keep memory. With mingw-w64, a thread frees its thread-local objects before it calls their
/// destructors (https://gcc.gnu.org/bugzilla/show_bug.cgi?id=80816).
#ifdef __MINGW32__
inline constexpr bool kKeepsMemory = false;
#else
inline constexpr bool kKeepsMemory = true;
#endif

/// Maximum size of a kept vector, in bytes, and maximum number of kept vectors per type.
inline constexpr std::size_t kMostKept = std::size_t{4} << 20, kMostVectorsKept = 4;

template <class T>
std::vector<std::vector<T>>& kept_memory() {
  thread_local std::vector<std::vector<T>> kept;
  return kept;
}

/// If the vector has no memory, gives it memory that this thread keeps for its type.
template <class T>
void borrow(std::vector<T>& vector) {
  if constexpr (kKeepsMemory) {
    auto& kept = kept_memory<T>();
    if (vector.capacity() > 0 || kept.empty()) return;
    vector = std::move(kept.back());
    kept.pop_back();
  }
}

/// Clears a vector and keeps its memory.
template <class T>
void keep(std::vector<T>& vector) {
  if constexpr (kKeepsMemory) {
    auto& kept = kept_memory<T>();
    if (vector.capacity() == 0 || vector.capacity() * sizeof(T) > kMostKept || kept.size() >= kMostVectorsKept) return;
    vector.clear();
    kept.push_back(std::move(vector));
    vector = {};
  }
}

/// An empty vector with kept memory.
template <class T>
struct KeptVector : std::vector<T> {
  KeptVector() { borrow<T>(*this); }
  explicit KeptVector(std::size_t size) : KeptVector() { this->resize(size); }
  ~KeptVector() { keep<T>(*this); }
  KeptVector(const KeptVector&) = delete;
  KeptVector& operator=(const KeptVector&) = delete;
};

}  // namespace scarp
