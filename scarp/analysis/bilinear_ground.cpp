// SPDX-License-Identifier: MIT
#include "scarp/analysis/bilinear_ground.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "scarp/base/error.h"
#include "scarp/march/height/max_mip.h"

namespace scarp {
namespace {

HeightField solid(const HeightField& field) {
  if (field.wraps()) throw Error("bilinear ground: wrapped fields have no border (use a field without wrap)");
  if (!field.has_cells())
    throw Error(fmt::format("bilinear ground: {} x {} samples have no cells between them (at least 2 x 2 are needed)",
                            field.cols(), field.rows()));
  HeightFieldSettings settings = field.settings();
  settings.surface = Surface::bilinear;
  settings.solid = true;
  return field.visit(
      [&](const auto& grid) { return HeightField::view(grid.data, grid.cols, grid.rows, settings, grid.row_stride); });
}

// The first cell of a ray that starts at a position and moves by (cols, rows) per t.
struct FirstCell {
  Cell cell;
  bool ground;  // not a hole
  double exit;  // t
};

// Nullopt if the ray leaves the field immediately. A ray along the line between two cells is in a cell with ground, if
// there is one.
std::optional<FirstCell> first_cell(const HeightField& field, double col, double row, double cols, double rows) {
  const auto index = [](double at, double step, int cells) {
    return step > 0   ? static_cast<int>(std::floor(at))
           : step < 0 ? static_cast<int>(std::ceil(at)) - 1
                      : std::min(static_cast<int>(std::floor(at)), cells - 1);
  };
  const auto exit = [](double at, double step, int cell) {
    return step > 0 ? (cell + 1 - at) / step : step < 0 ? (cell - at) / step : std::numeric_limits<double>::infinity();
  };
  const Cell cell{index(col, cols, field.cell_cols()), index(row, rows, field.cell_rows())};
  const auto inside = [&](const Cell& c) {
    return c.col >= 0 && c.row >= 0 && c.col < field.cell_cols() && c.row < field.cell_rows();
  };
  if (!inside(cell)) return std::nullopt;
  FirstCell first{cell, field.cell_heights(cell).has_value(),
                  std::min(exit(col, cols, cell.col), exit(row, rows, cell.row))};
  if (first.ground) return first;
  const Cell beside{cell.col - (cols == 0 && col == cell.col), cell.row - (rows == 0 && row == cell.row)};
  if (beside != cell && inside(beside) && field.cell_heights(beside)) {
    first.cell = beside;
    first.ground = true;
  }
  return first;
}

// Starts a ray on the surface, or free inside a hole.
void start_in(const FirstCell& first, Ray& ray) {
  if (first.ground) {
    ray.start = RayStart::on_surface;
    ray.start_cell = first.cell;
  } else {
    ray.t_min = first.exit / 2;
  }
}

// Finds the least clearance between the ends, at crossings and where a bilinear cell is nearest to the line.
void find_clearance(const HeightField& field, const SightLine& line, LineOfSight& result) {
  std::vector<double> times{0, 1};
  const auto cross = [&](double from, double to) {
    const double low = std::min(from, to), high = std::max(from, to);
    for (double k = std::floor(low) + 1; k < high; ++k) times.push_back((k - from) / (to - from));
  };
  cross(line.from().col, line.to().col);
  cross(line.from().row, line.to().row);
  std::sort(times.begin(), times.end());
  const auto consider = [&](double clearance, double along) {
    if (!(along > 0 && along < 1 && clearance < result.clearance)) return;
    result.clearance = clearance;
    result.clearance_along = along;
  };
  for (std::size_t i = 0; i + 1 < times.size(); ++i) {
    const double begin = times[i], end = times[i + 1], middle = (begin + end) / 2;
    if (!(begin < end)) continue;
    const Cell cell{std::min(static_cast<int>(line.col(middle)), field.cell_cols() - 1),
                    std::min(static_cast<int>(line.row(middle)), field.cell_rows() - 1)};
    const auto corners = field.cell_heights(cell);
    if (!corners) continue;
    // A quadratic, determined from three of its values.
    const auto clearance = [&](double along) {
      const double u = line.col(along) - cell.col, v = line.row(along) - cell.row;
      return line.eye() + along * (line.target() - line.eye()) -
             field.height_from_sample(height_in_cell(Surface::bilinear, *corners, u, v));
    };
    const double first = clearance(begin), last = clearance(end), bend = 2 * (first + last - 2 * clearance(middle));
    consider(first, begin);
    consider(last, end);
    const double lowest = bend > 0 ? 0.5 - (last - first) / (2 * bend) : 0;
    if (lowest > 0 && lowest < 1) consider(clearance(begin + lowest * (end - begin)), begin + lowest * (end - begin));
  }
}

}  // namespace

BilinearGround::BilinearGround(const HeightField& field)
    : field_(solid(field)), pyramid_(std::make_shared<const MaxPyramid>(field_)) {}

BilinearGround::BilinearGround(const HeightField& field, const BilinearGround& same_samples)
    : field_(solid(field)), pyramid_(same_samples.pyramid_) {}

Shade BilinearGround::shade(const SunRay& sun, Node node) const {
  const auto height = SightGround(field_).height(node);
  if (!height) return Shade::hole;
  const auto cols = static_cast<double>(sun.col), rows = static_cast<double>(sun.row);
  const auto first = first_cell(field_, node.col, node.row, cols, rows);
  if (!first) return Shade::lit;
  const HeightFieldSettings& cells = field_.settings();
  Ray ray{.origin = {node.col * cells.cell_x, (field_.rows() - 1 - node.row) * cells.cell_y, *height},
          .direction = {cols * cells.cell_x, -rows * cells.cell_y, sun.rise}};
  start_in(*first, ray);
  if (!occluded_max_mip(target(), ray)) return Shade::lit;
  if (!first->ground) return Shade::cast_shadow;
  ray.t_max = first->exit;
  return occluded_max_mip(target(), ray) ? Shade::self_shaded : Shade::cast_shadow;
}

// Returns what blocks a ray strictly; the ray starts on or above the surface.
Hit BilinearGround::block(Ray ray) const {
  const Hit hit = march_max_mip(target(), ray);
  if (!hit || ray.start == RayStart::on_surface || hit.wall) return hit;
  // A free ray hits ground that it only touches. From there on it hits only where it is strictly below.
  if (!(hit.t < ray.t_max)) return {};
  ray.t_min = hit.t;
  ray.start = RayStart::on_surface;
  ray.start_cell = hit.cell;
  return march_max_mip(target(), ray);
}

LineOfSight BilinearGround::line_of_sight(const SightEnd& from, const SightEnd& to) const {
  const SightLine line(field_, from, to, {.coefficient = 0});
  LineOfSight result;
  result.distance = line.distance();
  result.eye = line.eye();
  result.target = line.target();
  if (line.distance() == 0) return result;
  find_clearance(field_, line, result);
  const HeightFieldSettings& cells = field_.settings();
  const auto place = [&](const SightEnd& end, double height) {
    return dvec3(end.col * cells.cell_x, (field_.rows() - 1 - end.row) * cells.cell_y, height);
  };
  const dvec3 eye = place(line.from(), line.eye()), target = place(line.to(), line.target());
  const auto ray_from = [&](const SightEnd& begin, const SightEnd& end, const dvec3& start, const dvec3& stop,
                            bool on_ground) {
    Ray ray{.origin = start, .direction = stop - start};
    const auto first = first_cell(field_, begin.col, begin.row, end.col - begin.col, end.row - begin.row);
    if (on_ground && first) start_in(*first, ray);
    return ray;
  };
  // Both ends may be on the ground, but a ray only knows the surface at its start: a ray from each end covers half of
  // the line. The result is symmetric.
  Ray forth = ray_from(line.from(), line.to(), eye, target, line.eye() == line.ground_at_eye()),
      back = ray_from(line.to(), line.from(), target, eye, line.target() == line.ground_at_target());
  forth.t_max = back.t_max = 0.5;
  Hit hit = block(forth);
  if (!hit) {
    const Hit from_target = block(back);
    if (!from_target) return result;
    // The obstruction nearest to the observer.
    forth.t_max = 1 - from_target.t;
    hit = block(forth);
    if (!hit) {
      hit = from_target;
      hit.t = 1 - from_target.t;
    }
  }
  result.visible = false;
  result.obstruction = {hit.t, line.col(hit.t), line.row(hit.t), hit.height};
  return result;
}

}  // namespace scarp
