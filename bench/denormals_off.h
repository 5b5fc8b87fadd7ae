// SPDX-License-Identifier: MIT
// Flushes denormals to zero, as Embree recommends for each thread that calls it. Restored afterwards: Scarp does not
// need it.
#pragma once

#include <pmmintrin.h>
#include <xmmintrin.h>

namespace scarp::bench {

class DenormalsOff {
 public:
  DenormalsOff() : before_(_mm_getcsr()) {
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
  }
  ~DenormalsOff() { _mm_setcsr(before_); }
  DenormalsOff(const DenormalsOff&) = delete;
  DenormalsOff& operator=(const DenormalsOff&) = delete;

 private:
  unsigned before_;
};

}  // namespace scarp::bench
