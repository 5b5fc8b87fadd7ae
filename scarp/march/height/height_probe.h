// SPDX-License-Identifier: MIT
// The probe of height fields: the interface through which naive, fixed-step, relaxed and lipschitz sample a ray over
// one. The probe of functions is function/function_probe.h.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "scarp/march/height/height_target.h"
#include "scarp/march/ray_clip.h"
#include "scarp/march/sampling/sampling.h"
#include "scarp/march/usual_ray.h"

namespace scarp {

template <class T>
class HeightProbe {
 public:
  HeightProbe(const HeightTarget& target, const SampleGrid<T>& grid, const Ray& ray)
      : field_(*target.field),
        pyramid_(target.pyramid),
        grid_(grid),
        ray_(ray),
        local_(field_.grid_from_world(ray)),
        metres_(field_.settings().scale * field_.settings().exaggeration),
        speed_(length(ray.direction)),
        per_metre_(1 / speed_),
        has_holes_(field_.nodata_count() > 0) {
    t_exit = ray.t_max;
    double border = -std::numeric_limits<double>::infinity();
    if (!field_.wraps()) {
      clip_to_range(0, grid.cell_cols, local_.origin.x, local_.direction.x, border, t_exit);
      clip_to_range(0, grid.cell_rows, local_.origin.y, local_.direction.y, border, t_exit);
    }
    from_outside_ = ray.start == RayStart::free && border >= ray.t_min;
    t_enter = std::max(ray.t_min, border);
    // Vertical rays never leave sideways: they are followed down to the lowest ground.
    if (std::isinf(t_exit))
      clip_to_range(field_.min_sample(), field_.max_sample(), local_.origin.z, local_.direction.z, t_enter, t_exit);
  }

  double t_enter, t_exit;  ///< the ray inside the field's bounds; empty if t_enter > t_exit

  bool crosses() const { return t_enter <= t_exit && std::isfinite(t_exit) && speed_ > 0; }
  const Ray& ray() const { return ray_; }
  double per_metre() const { return per_metre_; }
  /// Whether the ray enters through the border, at t_enter.
  bool from_outside() const { return from_outside_; }

  struct Sample {
    bool valid = false;    ///< false over holes
    double clearance = 0;  ///< vertical distance above the ground, in metres
    Cell cell;
    double u = 0, v = 0;
  };
  /// t per unit of Sample::clearance.
  double per_clearance() const { return per_metre_; }
  Sample at(double t) const {
    const double col = over_field(local_.origin.x + local_.direction.x * t, grid_.cell_cols);
    const double row = over_field(local_.origin.y + local_.direction.y * t, grid_.cell_rows);
    Sample sample;
    sample.cell = {std::min(static_cast<int>(col), grid_.cell_cols - 1),
                   std::min(static_cast<int>(row), grid_.cell_rows - 1)};
    sample.u = col - sample.cell.col;
    sample.v = row - sample.cell.row;
    if (grid_.is_hole(sample.cell.col, sample.cell.row)) {
      // On the rim of a hole, which belongs to the ground beside it.
      const HeightField::Place there = field_.ground_at({sample.cell, sample.u, sample.v});
      sample.cell = there.cell, sample.u = there.u, sample.v = there.v;
      if (grid_.is_hole(sample.cell.col, sample.cell.row)) return sample;
    }
    const double ground =
        height_in_cell(field_.settings().surface, grid_.cell(sample.cell.col, sample.cell.row), sample.u, sample.v);
    sample.valid = true;
    sample.clearance = (local_.origin.z + local_.direction.z * t - ground) * metres_;
    return sample;
  }

  Hit hit(double t, const Sample& sample) const {
    Hit hit;
    hit.status = HitStatus::hit;
    hit.t = t;
    hit.cell = sample.cell;
    hit.u = sample.u;
    hit.v = sample.v;
    hit.height = ray_.at(t).z;
    return hit;
  }
  /// A hit at t; if that is over a hole, at the later t_sample.
  Hit hit_before(double t, double t_sample, const Sample& sample) const {
    const Sample there = at(t);
    return there.valid ? hit(t, there) : hit(t_sample, sample);
  }

  /// The t in which the ray travels the shorter side of a cell: the first step off the surface, and a step over a hole.
  double blind_step() const { return std::min(field_.settings().cell_x, field_.settings().cell_y) / speed_; }
  /// fixed-step's step, and its minimum as a fraction of the distance travelled.
  double stride(const MarchSettings& settings) const { return settings.fixed_step.step * blind_step(); }
  double stride_share(const MarchSettings&) const { return 0; }
  /// Minimum step of a ray below the ground, which may skip shorter stretches above the ground. At least what t can
  /// resolve.
  double least_step_under(double t) const { return std::max(0x1p-12 * blind_step(), 0x1p-50 * std::abs(t)); }
  /// Whether the ground is solid, with walls at its rims.
  bool solid() const { return field_.settings().solid; }

  bool under_ground(const Sample& sample) const { return sample.clearance < 0; }
  /// Returns a step that cannot reach the surface if the slope is within the bound that `shrink` assumes.
  double free_time(const Sample& sample, double shrink) const {
    return std::abs(sample.clearance) * shrink * per_metre_;
  }
  /// The time until which that bound holds, as it does not hold across holes: the exit from the largest hole-free block
  /// of the pyramid around the point; over a hole, from its cell.
  double bounded_until(const Sample& sample, double t) const {
    if (!sample.valid) return leave_time(sample.cell, 0, t);
    if (!has_holes_) return std::numeric_limits<double>::infinity();
    return leave_time(sample.cell, hole_free_level(sample.cell), t);
  }

 private:
  // Time at which the ray, over `cell` at t, leaves the block of 2^level x 2^level cells that contains it, plus a
  // margin of at most 2^-20 of a cell, far above rounding and far below any tolerance.
  double leave_time(Cell cell, int level, double t) const {
    const double x = time_to_border(local_.origin.x, local_.direction.x, cell.col, grid_.cell_cols, level, t);
    const double y = time_to_border(local_.origin.y, local_.direction.y, cell.row, grid_.cell_rows, level, t);
    return t + std::max(0.0, std::min(x, y)) + 0x1p-20 * blind_step();
  }
  double time_to_border(double o, double d, int cell, int cells, int level, double t) const {
    if (d == 0) return std::numeric_limits<double>::infinity();
    const int near = (cell >> level) << level, far = std::min(near + (1 << level), cells);
    return ((d > 0 ? far : near) - over_field(o + d * t, cells)) / d;
  }
  // Level 0 is the cell.
  int hole_free_level(Cell cell) const {
    int level = 0;
    while (level < pyramid_->top_level()) {
      const MaxPyramid::Level& next = pyramid_->levels()[static_cast<std::size_t>(level)];
      const std::ptrdiff_t row = cell.row >> (level + 1), col = cell.col >> (level + 1);
      if (pyramid_->minima()[next.begin + row * next.cols + col] == MaxPyramid::kNoMinimum) break;
      ++level;
    }
    return level;
  }
  double over_field(double position, int cells) const {
    if (field_.wraps()) position -= std::floor(position / cells) * cells;
    return std::clamp(position, 0.0, static_cast<double>(cells));
  }

  const HeightField& field_;
  const MaxPyramid* pyramid_;
  const SampleGrid<T>& grid_;
  const Ray& ray_;
  GridRay local_;
  double metres_;  // per sample unit
  double speed_;   // metres per t
  double per_metre_;
  bool has_holes_;
  bool from_outside_;
};

/// Calls march(probe, counted) if the ray can hit the ground.
template <class March>
Hit march_over(const HeightTarget& target, const Ray& ray, MarchStats* stats, const March& march) {
  require(target, HeightPart::none);
  if (const double longest = longest_of(ray.direction); !is_usual(longest)) [[unlikely]] {
    return at_usual_length(ray, longest, [&](const Ray& usual) { return march_over(target, usual, stats, march); });
  }
  MarchStats counted;
  Hit hit;
  if (target.field->has_cells() && !target.field->all_nodata()) {
    hit = target.field->visit([&](const auto& grid) {
      const HeightProbe probe(target, grid, ray);
      return probe.crosses() ? march(probe, counted) : Hit{};
    });
  }
  if (stats) *stats = counted;
  return hit;
}

}  // namespace scarp
