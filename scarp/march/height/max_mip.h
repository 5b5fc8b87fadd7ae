// SPDX-License-Identifier: MIT
// `max-mip`: hierarchical traversal of a maximum mipmap, down to cells and up again.
//
//   ray ---___          level 2:  [        ]   lowest ray height over the block > its maximum: leave the block
//             ---___    level 1:  [   ][   ]   otherwise: descend one level
//        /\       ---   level 0:  [ ][ ][ ][ ] in a cell: intersect its bilinear surface
//   ____/  \__/\____
//
// The integer cell is the state. Every crossing of a grid line has one time, t = (line - origin) / direction, in every
// context; the order of these times alone determines the visited cells, on every level. A hit is a sign change of (ray
// height - surface height) between two crossings, and each crossing is computed once: a ray that is above at one
// crossing and below at a later one cannot slip through a node, an edge or a diagonal. A bilinear cell with + at both
// ends is also tested at the vertex of its quadratic; a pair of triangles at its diagonal.
//
// Guarantee: exact. Never loses a hit; vertical error as derived in doc/dev/numerics.md. Source: A. Tevs, I. Ihrke,
// H.-P. Seidel, I3D 2008 (see accel/max_pyramid.h); the closed form of the bilinear cell as in S. D. Ramsey, K. Potter,
// C. Hansen, "Ray bilinear patch intersections", JGT 9(3), 2004. Cost: about 5 to 25 blocks per ray on mountains, 1 or
// 2 cells.
#pragma once

#include <vector>

#include "scarp/march/height/height_target.h"
#include "scarp/march/hit_rules.h"
#include "scarp/march/march_settings.h"

namespace scarp {

struct MarchTrace;  // base/march_trace.h

/// Closest hit; conventions as in ray.h. Requires the field's pyramid.
Hit march_max_mip(const HeightTarget& target, const Ray& ray, const MarchSettings& settings = {},
                  MarchStats* stats = nullptr);

/// Returns the closest hit that counts. From below, the march runs over the inverted ground (walk_ground.h), with the
/// same guarantee; solid ground then has no walls. A ray that starts on the surface is on the side that it heads for if
/// both sides count, and below it by definition if only the lower side does.
Hit march_max_mip_by_rules(const HeightTarget& target, const Ray& ray, const HitRules& rules,
                           MarchStats* stats = nullptr);

/// Closest hit with the paper's refinement instead of the closed form: where the signs at the ends of a cell differ,
/// settings.bisect.halvings bisections of the interval. Guarantee: approximate. Misses rays that dip below the surface
/// within a cell and emerge again; t has an error of up to the interval / 2^halvings.
Hit march_max_mip_bisect(const HeightTarget& target, const Ray& ray, const MarchSettings& settings = {},
                         MarchStats* stats = nullptr);

/// march_max_mip() and march_max_mip_bisect(), recorded: `trace` receives the blocks and cells of the walk. It stays
/// empty for a ray along a grid line of a field with holes, which is tested cell by cell.
Hit traced_max_mip(const HeightTarget& target, const Ray& ray, const MarchSettings& settings, MarchStats* stats,
                   MarchTrace& trace);
Hit traced_max_mip_bisect(const HeightTarget& target, const Ray& ray, const MarchSettings& settings, MarchStats* stats,
                          MarchTrace& trace);

/// Any hit: march_max_mip(...).status == hit, without computing t. A ray that was above at the entry of a block without
/// holes, and falls below the block's minimum, is occluded without further traversal. Over ground without holes and
/// wrap, vector code follows the ray first (max_mip_ahead.h).
bool occluded_max_mip(const HeightTarget& target, const Ray& ray);

/// All hits in the ray's range, in order of t: each time the ray goes from above to on or below the surface (at most
/// once per cell), and through walls into solid ground. Overwrites `hits`; the first is that of march_max_mip. Returns
/// `hit`, or why there is none.
HitStatus all_hits_max_mip(const HeightTarget& target, const Ray& ray, std::vector<Hit>& hits);

}  // namespace scarp
