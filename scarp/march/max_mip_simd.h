// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scarp/march/marches.h"

namespace scarp {

struct SimdLab {
  const std::uint32_t* words = nullptr;  // max << 16 | min
  double relief_per_cell = 0;            // sample units
  int planes = 0, first = 1, first_nodes = 1, gather = 0, packets = 2, leaf_wait = 4, refill = 4;
  std::uint64_t node_steps = 0, node_lanes = 0, leaf_steps = 0, leaf_lanes = 0, resumed = 0, unprepared = 0, refills = 0;
};
extern SimdLab lab;

void occluded_max_mip_simd(const HeightTarget& target, std::span<const Ray> rays, std::uint8_t* blocked);

void closest_hits_max_mip_simd(const HeightTarget& target, std::span<const Ray> rays, Hit* hits);

}  // namespace scarp
