// SPDX-License-Identifier: MIT
#include "scarp/scene/plinth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace scarp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Thickness below the lowest point, as fractions of the relief and of the shorter side.
constexpr double kOfRelief = 0.15;
constexpr double kOfSide = 0.03;

// Whether the ray is on or under the edge of a cell that it crosses at t. The edge belongs to the cell's near or far
// side across axis `across` (0: columns, 1: rows) and runs along the other one.
bool under_edge(const CellHeights& h, const std::array<int, 2>& cell, const GridRay& ray, std::size_t across,
                bool far_side, double t) {
  const std::size_t along = 1 - across;
  const int axis = static_cast<int>(along);
  const double f = std::clamp(ray.origin[axis] + t * ray.direction[axis] - cell[along], 0.0, 1.0);
  const double from = !far_side ? h.h00 : across == 0 ? h.h10 : h.h01;
  const double to = far_side ? h.h11 : across == 0 ? h.h01 : h.h10;
  return ray.origin.z + t * ray.direction.z <= from + f * (to - from);
}

// Whether the ray is under the ground of a cell that it is over at t.
bool under_ground(const HeightField& field, const CellHeights& h, const std::array<int, 2>& cell, const GridRay& ray,
                  double t) {
  const double u = std::clamp(ray.origin.x + t * ray.direction.x - cell[0], 0.0, 1.0);
  const double v = std::clamp(ray.origin.y + t * ray.direction.y - cell[1], 0.0, 1.0);
  return ray.origin.z + t * ray.direction.z < height_in_cell(field.settings().surface, h, u, v);
}

}  // namespace

double plinth_base(const HeightField& field) {
  const double relief = field.max_height() - field.min_height();
  return field.min_height() - std::max(kOfRelief * relief, kOfSide * std::min(field.width(), field.depth()));
}

Plinth::Plinth(const HeightField& field, double base)
    : field_(field),
      base_sample_((base / field.settings().exaggeration - field.settings().offset) / field.settings().scale) {}

std::optional<Plinth::Wall> Plinth::intersect(const Ray& ray) const {
  if (!field_.has_cells()) return {};
  const GridRay local = field_.grid_from_world(ray);
  // Clip to the box of plinth and terrain. side: the axis whose face the ray enters through, 2 for top and base, -1
  // when it starts inside.
  const std::array<double, 3> low{0, 0, base_sample_};
  const std::array<double, 3> high{field_.cols() - 1.0, field_.rows() - 1.0, field_.max_sample()};
  double t_in = ray.t_min, t_out = ray.t_max;
  int side = -1;
  for (int axis = 0; axis < 3; ++axis) {
    const double o = local.origin[axis], d = local.direction[axis];
    const auto i = static_cast<std::size_t>(axis);
    if (d == 0) {
      if (o < low[i] || o > high[i]) return {};
      continue;
    }
    const double a = (low[i] - o) / d, b = (high[i] - o) / d;
    if (std::min(a, b) > t_in) {
      t_in = std::min(a, b);
      side = axis;
    }
    t_out = std::min(t_out, std::max(a, b));
  }
  if (!(t_in <= t_out)) return {};
  const bool has_holes = field_.nodata_count() > 0;
  const bool from_top = side == 2 && local.direction.z < 0;
  // Inside the border, only the rims of holes have walls.
  if (from_top && !has_holes) return {};

  // Walk the cells from crossing to crossing.
  std::array<int, 2> cell{}, step{};
  std::array<double, 2> next{};
  const std::array<int, 2> cells{field_.cell_cols(), field_.cell_rows()};
  const auto crossing_ahead = [&](std::size_t i) {
    const int axis = static_cast<int>(i);
    if (local.direction[axis] == 0) return kInfinity;
    return (cell[i] + (step[i] > 0 ? 1 : 0) - local.origin[axis]) / local.direction[axis];
  };
  for (int axis = 0; axis < 2; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    const double d = local.direction[axis];
    cell[i] = std::clamp(static_cast<int>(std::floor(local.origin[axis] + t_in * d)), 0, cells[i] - 1);
    if (side == axis) cell[i] = d > 0 ? 0 : cells[i] - 1;
    step[i] = d > 0 ? 1 : -1;
    next[i] = crossing_ahead(i);
  }
  double t = t_in;
  std::size_t crossed = side == 1 ? 1 : 0;
  bool from_outside = side == 0 || side == 1;
  if (!from_outside && !from_top) {
    const auto heights = field_.cell_heights({cell[0], cell[1]});
    if (heights && under_ground(field_, *heights, cell, local, t)) return {};
  }
  while (t <= t_out) {
    const auto heights = field_.cell_heights({cell[0], cell[1]});
    if (heights && from_outside) {
      const bool far_side = step[crossed] < 0;
      if (under_edge(*heights, cell, local, crossed, far_side, t)) {
        // Rows count southwards, y northwards.
        const bool at_low_side = (step[crossed] > 0) == (crossed == 0);
        if (crossed == 0) return Wall{t, at_low_side ? VoxelFace::low_x : VoxelFace::high_x};
        return Wall{t, at_low_side ? VoxelFace::low_y : VoxelFace::high_y};
      }
    }
    if (!has_holes) return {};
    crossed = next[0] <= next[1] ? 0 : 1;
    t = next[crossed];
    // Below the surface without having crossed a wall: the ray came through the surface and hit it there.
    if (heights && under_edge(*heights, cell, local, crossed, step[crossed] > 0, t)) return {};
    from_outside = !heights;
    cell[crossed] += step[crossed];
    if (cell[crossed] < 0 || cell[crossed] >= cells[crossed]) return {};
    next[crossed] = crossing_ahead(crossed);
  }
  return {};
}

}  // namespace scarp
