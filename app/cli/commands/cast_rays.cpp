// SPDX-License-Identifier: MIT
#include "app/cli/commands/cast_rays.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "scarp/base/error.h"

namespace scarp::cli {
namespace {

// Returns how far in metres a ray from the surface starts above or below it. Throws Error, without file and line,
// unless it starts over its cell or one of the cells around it: a rounded hit on a border is over one of these.
double off_surface(const Ray& ray, const HeightField& field) {
  const GridRay grid = field.grid_from_world(ray);
  const dvec3 at = grid.origin + grid.direction * ray.t_min;
  const ivec3 cell(ray.start_cell.col, ray.start_cell.row, 0), count(field.cell_cols(), field.cell_rows(), 0);
  double place[2];
  for (int axis = 0; axis < 2; ++axis) {
    place[axis] = at[axis] - cell[axis];
    if (field.wraps()) place[axis] -= count[axis] * std::round((place[axis] - 0.5) / count[axis]);
    if (!(place[axis] >= -1 && place[axis] <= 2)) {
      throw Error(
          fmt::format("it starts at column {:.10g}, row {:.10g} of the samples, which is not in the cell of start_col "
                      "{} and start_row {}, nor next to it",
                      at.x, at.y, cell.x, cell.y));
    }
  }
  const CellHeights heights = *field.cell_heights(ray.start_cell);
  const double u = std::clamp(place[0], 0.0, 1.0), v = std::clamp(place[1], 0.0, 1.0);
  return std::abs(ray.at(ray.t_min).z -
                  field.height_from_sample(height_in_cell(field.settings().surface, heights, u, v)));
}

// Throws Error, without file and line, unless the scene accepts the ray. Returns its off_surface().
double require_valid(const Ray& ray, const Scene& scene) {
  if (ray.start == RayStart::on_surface && !scene.terrain())
    throw Error("start_col and start_row name a cell, and the scene is not one terrain (leave them empty)");
  validate(ray, scene);
  return ray.start == RayStart::on_surface ? off_surface(ray, *scene.terrain()) : 0;
}

}  // namespace

std::vector<Ray> placed_rays(RayTable& table, const CoordinateFrame& frame, bool skip_bad) {
  if (!skip_bad) return rays_in_local(table, frame);
  try {
    return rays_in_local(table, frame);
  } catch (const Error&) {
    // Nearly all tables are converted at once. Here one by one, to find all bad rays.
  }
  RayTable one;
  one.path = table.path, one.aim = table.aim;
  std::vector<BadRay> bad;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    one.rows = {table.rows[i]}, one.indices = {table.index(i)};
    try {
      rays_in_local(one, frame);
    } catch (const Error& error) {
      bad.push_back({table.index(i), error.what()});
    }
  }
  table.leave_out(bad);
  return rays_in_local(table, frame);
}

std::vector<std::string> check_rays(RayTable& table, std::vector<Ray>& rays, const Scene& scene, bool skip_bad) {
  constexpr std::string_view kPrefix = "ray: ";
  double farthest = 0;
  std::vector<BadRay> bad;
  std::vector<Ray> good;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    rays[i].start_object = scene.terrain_object();
    try {
      farthest = std::max(farthest, require_valid(rays[i], scene));
      if (!bad.empty()) good.push_back(rays[i]);
    } catch (const Error& error) {
      // Here the ray has a name.
      std::string_view text = error.what();
      if (text.starts_with(kPrefix)) text.remove_prefix(kPrefix.size());
      const std::string why = fmt::format("{}: {}", table.where(i), text);
      if (!skip_bad) throw Error(why);
      if (bad.empty()) good.assign(rays.begin(), rays.begin() + static_cast<std::ptrdiff_t>(i));
      bad.push_back({table.index(i), why});
    }
  }
  if (!bad.empty()) {
    rays = std::move(good);
    table.leave_out(bad);
  }
  std::vector<std::string> notes;
  if (!table.bad.empty()) {
    const std::string& first = table.bad.front().why;
    if (rays.empty()) throw Error(fmt::format("no ray can be used; the first: {}", first));
    notes.push_back(
        fmt::format("{} of {} rays skipped; the first: {}", table.bad.size(), rays.size() + table.bad.size(), first));
  }
  if (farthest == 0) return notes;
  const HeightFieldSettings& cells = scene.terrain()->settings();
  if (farthest > std::min(cells.cell_x, cells.cell_y))
    notes.push_back(fmt::format(
        "rays with start_col and start_row start on the surface, but z is up to {:.3g} m away from it; it counts as "
        "the height of the surface there",
        farthest));
  return notes;
}

}  // namespace scarp::cli
