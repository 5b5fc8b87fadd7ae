// SPDX-License-Identifier: MIT
// Private to the station: sweeps, overlaps and closest points over many objects, for BoxTree::search(). Results do not
// depend on the order of the search: they equal those of separate queries of each object.
#pragma once

#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>

#include "scarp/base/world_box.h"
#include "scarp/march/turned_box.h"

namespace scarp {

/// Rounding of placed points and boxes, relative to their coordinates, with a margin.
inline constexpr double kPlacing = 0x1p-47;

/// At the same time or distance, the object with the lower index counts.
inline bool is_before(double a, std::uint32_t a_object, double b, std::uint32_t b_object) {
  return a < b || (a == b && a_object < b_object);
}

/// 0 if something in `other` may overlap the box, else infinity.
inline double overlap_bound(const TurnedBox& box, const WorldBox& other) {
  const double wide = kPlacing * (length(box.centre) + length(box.half) + length(other.low) + length(other.high));
  return overlaps(box, other.low - wide, other.high + wide) ? 0 : std::numeric_limits<double>::infinity();
}

/// The distance of p from a box, and the maximum distance of boxes that may contain something at a given distance.
inline double distance_bound(const dvec3& p, const WorldBox& box) { return length(min(max(p, box.low), box.high) - p); }
inline double reach_of(const dvec3& p, double distance) { return distance + kPlacing * (distance + length(p)); }

/// within(most) returns the point of an object that is closest to p, if it is within `most`; this returns
/// within(max_distance), or nullopt if `best` is closer. Which of several equally close points an object finds depends
/// on its search distance, so the limit is always the same.
template <class Within>
auto closest_of_object(const dvec3& p, double max_distance, const std::optional<double>& best, const Within& within)
    -> decltype(within(max_distance)) {
  if (best && !within(reach_of(p, *best))) return {};
  return within(max_distance);
}

}  // namespace scarp
