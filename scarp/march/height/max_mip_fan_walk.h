// SPDX-License-Identifier: MIT
// Between max_mip_fan.cpp and the vector code of max_mip_fan_simd.cpp.
#pragma once

#include <cstddef>
#include <vector>

#include "scarp/march/height/max_mip_fan.h"

namespace scarp::max_mip {

/// A ray that floats do not decide, by its place in the arrays. It is above the ground up to t_clear, or kNotClear.
struct FanRest {
  std::ptrdiff_t ray;
  double t_clear;
};

/// Whether vectors walk over the field and from the origin: otherwise all rays go to the batch.
bool walks_fan(const HeightTarget& target, const Fan& fan);

/// Answers the rays of columns [begin, end) but for those that it appends to `rest`.
void walk_fan(const HeightTarget& target, const Fan& fan, const FanHits& hits, int begin, int end,
              const FanOptions& options, std::vector<FanRest>& rest, FanStats& stats);

}  // namespace scarp::max_mip
