// SPDX-License-Identifier: MIT
// All of Embree's calls that trace rays: one at a time, packets of 4, 8 and 16, and streams (rtcIntersect1M).
#pragma once

#include <embree3/rtcore.h>

#include <cstdint>
#include <string>
#include <vector>

#include "bench/rays.h"

namespace scarp::bench {

struct EmbreeMode {
  std::string name;  ///< "x1", "x8-coherent", "x1m-256-incoherent" (a stream of 256 rays)
  /// Like Engine::trace, through `mode`.
  void (*trace)(RTCScene scene, const EmbreeMode& mode, const RaySet& set, std::int64_t begin, std::int64_t end,
                float* answers);
  RTCIntersectContextFlags flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  std::int64_t stream = 0;  ///< rays in a stream
};

/// x1 first. The same object in each call.
const std::vector<EmbreeMode>& embree_modes();

}  // namespace scarp::bench
