// SPDX-License-Identifier: MIT
// What the sampling marches (naive, relaxed) need of a height field: the ray inside its bounds, and how far above the
// ground a point of it is.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "scarp/march/height/height_target.h"
#include "scarp/march/ray_clip.h"

namespace scarp {

template <class T>
class Ground {
 public:
  Ground(const HeightField& field, const SampleGrid<T>& grid, const Ray& ray)
      : field_(field),
        grid_(grid),
        ray_(ray),
        local_(field.grid_from_world(ray)),
        metres_(field.settings().scale * field.settings().exaggeration),
        speed_(length(ray.direction)) {
    t_enter = ray.t_min;
    t_exit = ray.t_max;
    if (!field.wraps()) {
      clip(0, grid.cell_cols, local_.origin.x, local_.direction.x);
      clip(0, grid.cell_rows, local_.origin.y, local_.direction.y);
    }
    // Upright rays never leave sideways: they are followed as far as there is ground.
    if (std::isinf(t_exit)) clip(field.min_sample(), field.max_sample(), local_.origin.z, local_.direction.z);
  }

  double t_enter, t_exit;  ///< the ray inside the field's bounds; empty when t_enter > t_exit

  bool crosses() const { return t_enter <= t_exit && std::isfinite(t_exit) && speed_ > 0; }
  double metres_per_t() const { return speed_; }
  /// The t in which the ray goes as far as a cell is long, its shorter side.
  double cell_time() const { return std::min(field_.settings().cell_x, field_.settings().cell_y) / speed_; }

  /// When the ray, over `cell` at t, leaves the block of 2^level x 2^level cells that holds it: a little later, so that
  /// it has, but by no more than 2^-20 of a cell, which is far beyond rounding and far below any tolerance.
  double leave_time(Cell cell, int level, double t) const {
    const double x = time_to_border(local_.origin.x, local_.direction.x, cell.col, grid_.cell_cols, level, t);
    const double y = time_to_border(local_.origin.y, local_.direction.y, cell.row, grid_.cell_rows, level, t);
    return t + std::max(0.0, std::min(x, y)) + 0x1p-20 * cell_time();
  }

  struct Sample {
    bool valid = false;    ///< false over holes
    double clearance = 0;  ///< metres that the ray is above the ground, vertically
    Cell cell;
    double u = 0, v = 0;
  };
  Sample at(double t) const {
    const double col = over_field(local_.origin.x + local_.direction.x * t, grid_.cell_cols);
    const double row = over_field(local_.origin.y + local_.direction.y * t, grid_.cell_rows);
    Sample sample;
    sample.cell = {std::min(static_cast<int>(col), grid_.cell_cols - 1),
                   std::min(static_cast<int>(row), grid_.cell_rows - 1)};
    sample.u = col - sample.cell.col;
    sample.v = row - sample.cell.row;
    if (grid_.is_hole(sample.cell.col, sample.cell.row)) return sample;
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

 private:
  double time_to_border(double o, double d, int cell, int cells, int level, double t) const {
    if (d == 0) return std::numeric_limits<double>::infinity();
    const int near = (cell >> level) << level, far = std::min(near + (1 << level), cells);
    return ((d > 0 ? far : near) - over_field(o + d * t, cells)) / d;
  }
  double over_field(double position, int cells) const {
    if (field_.wraps()) position -= std::floor(position / cells) * cells;
    return std::clamp(position, 0.0, static_cast<double>(cells));
  }
  void clip(double low, double high, double o, double d) { clip_to_range(low, high, o, d, t_enter, t_exit); }

  const HeightField& field_;
  const SampleGrid<T>& grid_;
  const Ray& ray_;
  GridRay local_;
  double metres_;  // per sample unit
  double speed_;   // metres per t
};

}  // namespace scarp
