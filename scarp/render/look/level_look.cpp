// SPDX-License-Identifier: MIT
#include "scarp/render/look/level_look.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "scarp/accel/max_pyramid.h"
#include "scarp/base/error.h"
#include "scarp/march/ray_clip.h"
#include "scarp/scene/plinth.h"

namespace scarp {
namespace {

// Sides that face east or west, north or south, up or down.
constexpr std::array<float, 3> kShades = {0.7f, 0.5f, 1.0f};

const HeightField& field_of(const Scene& scene) {
  const HeightField* field = scene.only_heights();
  if (!field) throw Error("picture: the look level needs a single height field");
  if (field->wraps()) throw Error("picture: the look level shows boxes within borders (leave out the wrap)");
  return *field;
}

// The ray along one horizontal axis, in blocks.
struct Axis {
  double origin, direction;

  int block_at(double t, int blocks) const {
    return std::clamp(static_cast<int>(std::floor(origin + direction * t)), 0, blocks - 1);
  }
  // Where the ray leaves a block.
  double leave(int block) const {
    if (direction == 0) return std::numeric_limits<double>::infinity();
    return (block + (direction > 0 ? 1 : 0) - origin) / direction;
  }
};

}  // namespace

LevelBoxes::LevelBoxes(const Scene& scene, int level)
    : field_(field_of(scene)), level_(level), base_(plinth_base(field_)) {
  const MaxPyramid pyramid(field_);
  if (level > pyramid.top_level()) {
    throw Error(fmt::format("picture: there is no level {} (the pyramid over {} x {} cells has levels 0 to {})", level,
                            field_.cell_cols(), field_.cell_rows(), pyramid.top_level()));
  }
  cols_ = ((field_.cell_cols() - 1) >> level) + 1, rows_ = ((field_.cell_rows() - 1) >> level) + 1;
  highest_ = field_.height_from_sample(pyramid.maximum(pyramid.top_level(), 0, 0));
  if (level == 0) return;
  for (int row = 0; row < rows_; ++row) {
    for (int col = 0; col < cols_; ++col) {
      maxima_.push_back(has_ground(col, row) ? field_.height_from_sample(pyramid.maximum(level, col, row))
                                             : std::numeric_limits<double>::quiet_NaN());
    }
  }
}

bool LevelBoxes::has_ground(int col, int row) const {
  if (field_.nodata_count() == 0) return true;
  const int side = 1 << level_, last_col = std::min((col + 1) * side, field_.cell_cols()),
            last_row = std::min((row + 1) * side, field_.cell_rows());
  for (int r = row * side; r < last_row; ++r) {
    for (int c = col * side; c < last_col; ++c) {
      if (field_.cell_heights({c, r})) return true;
    }
  }
  return false;
}

// NaN: no box.
double LevelBoxes::maximum_of(int col, int row) const {
  if (level_ > 0)
    return maxima_[static_cast<std::size_t>(row) * static_cast<std::size_t>(cols_) + static_cast<std::size_t>(col)];
  const auto h = field_.cell_heights({col, row});
  return h ? field_.height_from_sample(std::max({h->h00, h->h10, h->h01, h->h11}))
           : std::numeric_limits<double>::quiet_NaN();
}

std::optional<LevelBoxes::Hit> LevelBoxes::hit(const Ray& ray) const {
  const double side = std::ldexp(1.0, level_);
  const GridRay grid = field_.grid_from_world(ray);
  const Axis x{grid.origin.x / side, grid.direction.x / side}, y{grid.origin.y / side, grid.direction.y / side};
  const double z = ray.origin.z, dz = ray.direction.z;
  // The box around all boxes, axis by axis: the last one decides through which side the ray enters it.
  double t = ray.t_min, t_end = ray.t_max;
  int entered = -1;
  const std::array<double, 3> low{0, 0, base_}, high{field_.cell_cols() / side, field_.cell_rows() / side, highest_};
  const std::array<double, 3> origin{x.origin, y.origin, z}, direction{x.direction, y.direction, dz};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double before = t;
    clip_to_range(low[axis], high[axis], origin[axis], direction[axis], t, t_end);
    if (t > before) entered = static_cast<int>(axis);
  }
  if (!(t <= t_end)) return {};
  int col = x.block_at(t, cols_), row = y.block_at(t, rows_);
  for (;;) {
    const double t_x = x.leave(col), t_y = y.leave(row), t_next = std::min({t_x, t_y, t_end});
    // Comparisons with NaN fail. A ray that starts in a box has entered none.
    const double top = maximum_of(col, row), here = z + dz * t;
    if (entered >= 0 && here <= top) return Hit{top, kShades[static_cast<std::size_t>(entered)]};
    if (here > top && dz < 0 && (top - z) / dz <= t_next) return Hit{top, kShades[2]};
    if (t_next >= t_end) return {};
    t = t_next;
    entered = t_x <= t_y ? 0 : 1;
    if (entered == 0) {
      col += x.direction > 0 ? 1 : -1;
    } else {
      row += y.direction > 0 ? 1 : -1;
    }
    if (col < 0 || col >= cols_ || row < 0 || row >= rows_) return {};
  }
}

}  // namespace scarp
