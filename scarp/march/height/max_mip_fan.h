// SPDX-License-Identifier: MIT
// `max-mip` for fans: rays of one origin in columns of rising slope, as a camera or a scanner has them.
//
//             ____----  row 2      A ray inherits the way on which the ray below it was found to be above the ground.
//     eye o---______    row 1      A column of rays is therefore one walk over the grid lines that it crosses: it needs
//            \   ___\__            a test per line and one per ray, not a walk per ray.
//         row 0\/       \__        16 columns are the lanes of a vector. All are at the same line, so the samples that
//      ground _/\___       \_      they need are next to one another: one load per line for all.
//
// A ray inherits from another one if the ground between both cannot be so steep that it reaches the upper one and not
// the lower: its slope must be higher by the steepest edge nearby (accel/relief_map.h) times their distance to the
// side. Rows of a scanner and of an upright camera are such; so are those of most tilted cameras. Where the rays of all
// columns are above the tilted planes of the pyramid, many lines are skipped at once.
//
// Wrapped ground goes on through all copies, so that lines and nodes are counted beyond the grid and looked up within
// it; a walk ends with its rays, which must end, or where few are left.
//
// Floats decide what a margin proves (doc/dev/numerics.md): that a ray is above the ground, or that it is above at one
// place and below at a later one. Rays without such a proof, and those that inherit nothing, go to march_max_mip() and
// its batch form, as do all rays of an eye below the ground. A ray hits here if it hits there.
//
// Source: own. That a column of pixels is drawn from near to far in one pass is known from games with voxel landscapes
// (NovaLogic's "Comanche", 1992). Cost: no memory besides the pyramid; pays off if the rows are not far fewer than the
// lines that a ray crosses.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "scarp/march/height/height_target.h"

namespace scarp {

/// Columns that are followed together: the lanes of a vector.
constexpr int kFanStrip = 16;

/// Rays of one origin. The ray of column c and row r is at r * row_stride + c / 16 * strip_stride + c % 16 of each
/// array. In rows: row_stride = columns, strip_stride = 16; in strips of 16 columns: row_stride = 16, strip_stride = 16
/// * rows. Rows should be in the order of their slope, rising or falling; they are faster then.
struct Fan {
  dvec3 origin{0.0};
  const float *dx = nullptr, *dy = nullptr, *dz = nullptr;  ///< directions in world space, of any length
  int columns = 0, rows = 0;
  std::ptrdiff_t row_stride = 0, strip_stride = 16;
  double t_min = 0;                                        ///< of all rays
  double t_max = std::numeric_limits<double>::infinity();  ///< of all rays
};

/// Answers, laid out as the rays.
struct FanHits {
  float* t = nullptr;                           ///< infinity if the ray hits nothing; rounded to float
  std::int32_t *col = nullptr, *row = nullptr;  ///< cell of the hit; -1 if there is none
  float *u = nullptr, *v = nullptr;             ///< position in the cell, 0..1; 0 if there is no hit
  HitStatus* status = nullptr;                  ///< optional
  /// Optional, all or none: the upward unit normal of the surface at the hit, HeightField::normal() of the cell, u and
  /// v; that of the wall if solid ground is hit there; 0 if there is no hit.
  float *nx = nullptr, *ny = nullptr, *nz = nullptr;
};

/// Closest hits. hits.status and so the choice between hit and none equals march_max_mip() of each ray; t, cell, u and
/// v are those of the same hit within the tolerance of fans in numerics.md. Rays that no batch accepts (a direction of
/// zero or NaN) miss. Runs on the calling thread, for the columns [column_begin, column_end); column_begin should be a
/// multiple of 16.
void closest_hits_max_mip_fan(const HeightTarget& target, const Fan& fan, const FanHits& hits, int column_begin,
                              int column_end);
inline void closest_hits_max_mip_fan(const HeightTarget& target, const Fan& fan, const FanHits& hits) {
  closest_hits_max_mip_fan(target, fan, hits, 0, fan.columns);
}

/// The finding of a fan about a ray, in place of its hit: enough to compute the hit in double without a march.
struct FanSight {
  /// Cells along the longer axis from the origin. Up to there the ray is above the ground and then hits in `cell`;
  /// infinity: it hits nothing. Negative: it is above up to -clear, no more is known; -infinity: nothing is known.
  float clear;
  std::uint32_t cell;  ///< col + 2^16 row
};

/// Whether look_max_mip_fan() finds anything over this field and from this origin, and is likely to be faster than a
/// batch. `first` and `last`: directions of the rays at two opposite corners; those of `fan` are not read. Over a field
/// that wraps, t_max is as for look_max_mip_fan().
bool looks_by_fan(const HeightTarget& target, const Fan& fan, const dvec3& first, const dvec3& last);

/// Sets sights, laid out as the rays, for t_min = 0 and any t_max. The rays may be given in double elsewhere: sights
/// are also those of rays whose directions, or multiples of them, round to these floats. Over a field that wraps, the
/// rays are followed up to fan.t_max, which must be finite: rays beyond it are only slower. Threads and columns as
/// above.
void look_max_mip_fan(const HeightTarget& target, const Fan& fan, FanSight* sights, int column_begin, int column_end);

/// hits[i] is march_max_mip() of rays[i], bit for bit. sights[i] is that of the ray; its t_min is 0. Runs on the
/// calling thread.
void closest_hits_max_mip_seen(const HeightTarget& target, std::span<const Ray> rays, std::span<const FanSight> sights,
                               std::span<Hit> hits);

/// Options to measure with; they change no answer.
struct FanOptions {
  bool jumps = true;    ///< skip lines below tilted planes
  bool always = false;  ///< also where the batch is likely to be faster
  float margin = 1;     ///< factor of the margin; below 1 hits may be lost
};

/// Counters of fans on this thread since the last query.
struct FanStats {
  std::uint64_t rays = 0, strips = 0, lines = 0, turns = 0;  ///< lines and turns: of strips
  std::uint64_t jump_tries = 0, jumps = 0, wide_lines = 0;
  std::uint64_t resumed = 0, from_start = 0;  ///< rays that the scalar march and the batch answered
};
FanStats take_fan_stats();

void closest_hits_max_mip_fan(const HeightTarget& target, const Fan& fan, const FanHits& hits, int column_begin,
                              int column_end, const FanOptions& options);
void look_max_mip_fan(const HeightTarget& target, const Fan& fan, FanSight* sights, int column_begin, int column_end,
                      const FanOptions& options);

}  // namespace scarp
