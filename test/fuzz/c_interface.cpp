// SPDX-License-Identifier: MIT
// Any bytes as a sequence of calls of the C interface: each answers or is refused.
#include <cstdint>
#include <exception>

#include "c/hostile.h"
#include "fuzz/fuzz.h"

namespace {

// More calls per input would take longer than they find.
constexpr int kMostCalls = 100;

// Two bytes are a number.
struct Bytes {
  const std::uint8_t* next;
  std::size_t left;

  std::uint32_t operator()() {
    if (left < 2) {
      left = 0;
      return 0;
    }
    left -= 2, next += 2;
    return next[-2] + 256u * next[-1];
  }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    scarp::test::Hostile hostile(Bytes{data, size});
    for (int call = 0; call < kMostCalls && hostile.bits().left > 0; ++call) hostile.call();
  } catch (const std::exception&) {
    scarp::fuzz::require(false);
  }
  scarp::fuzz::require(scarp_use_threads(nullptr) == SCARP_OK);
  return 0;
}
