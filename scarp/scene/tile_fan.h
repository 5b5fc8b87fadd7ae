// SPDX-License-Identifier: MIT
// Private to the station: a batch of rays of one origin over tiles, as cameras and scanners give them. Each strip of 16
// columns goes over the tiles as a fan (march/height/max_mip_fan.h), in rings around the origin:
//
//     2 1 2 3      All rays of one origin cross the tiles in rising order of the rings, so no ray has a walk of its
//     own. 1 o 1 2      A ray is done at the end of a ring in which it hits, unless the hit is at the border of a tile.
//     2 1 2 3
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "scarp/march/height/fan_batch.h"
#include "scarp/scene/tile_walk.h"

namespace scarp {

/// Sets the hits of the rays on tiles, without Hit::object, bit for bit as a single ray has them, and calls
/// others(rays) with the indices of the rays that it leaves to other code: those whose hit is at the border of a tile,
/// that start or enter below the ground, that do not belong to the fan, or that a fan does not help. Runs on all
/// threads. Returns false, doing nothing, if the origin is below the ground or there are very many tiles.
bool closest_hits_in_tile_fan(const TileGrid& grid, const FanBatch& batch, std::span<const Ray> rays,
                              std::span<Hit> hits, const std::function<void(std::span<const std::uint32_t>)>& others);

}  // namespace scarp
