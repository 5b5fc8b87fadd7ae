// SPDX-License-Identifier: MIT
// Number of random cases in a test.
#pragma once

#include <cstdlib>

namespace scarp::test {

/// Returns `usual` in optimised builds, `many` in those under `./dev test --long`, and `checked` in builds with
/// assertions or the thread sanitizer, where each case takes ten times as long and memory accesses soon repeat.
inline int cases([[maybe_unused]] int many, [[maybe_unused]] int usual, [[maybe_unused]] int checked) {
#if defined(NDEBUG) && !defined(__SANITIZE_THREAD__)
  return std::getenv("SCARP_LONG_TESTS") ? many : usual;
#else
  return checked;
#endif
}

}  // namespace scarp::test
