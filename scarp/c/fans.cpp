// SPDX-License-Identifier: MIT
#include <algorithm>
#include <limits>
#include <vector>

#include "scarp/c/scene_handle.h"
#include "scarp/c/structures.h"
#include "scarp/c/threads.h"
#include "scarp/scene/cast_from.h"

namespace scarp::c {
namespace {

double end_of(double t_max) { return t_max == 0 ? std::numeric_limits<double>::infinity() : t_max; }

scarp_fan_answers answers_from(const scarp_fan_answers* given) {
  const scarp_fan_answers to = read(given, "fan_answers");
  if (!to.nx != !to.ny || !to.nx != !to.nz) throw Error("fan_answers: nx, ny and nz are given together or not at all");
  return to;
}

template <class From, class To>
void copy(const std::vector<From>& from, To* to) {
  if (to) std::transform(from.begin(), from.end(), to, [](From value) { return static_cast<To>(value); });
}

// Casts into arrays of its own, because the caller may leave out some.
template <class Cast>
void cast_into(const scarp_fan_answers& to, std::int32_t columns, std::int32_t rows, const Cast& cast) {
  FanAnswers found(columns, rows, to.nx != nullptr);
  cast(found);
  copy(found.t, to.t), copy(found.col, to.col), copy(found.row, to.row);
  copy(found.u, to.u), copy(found.v, to.v), copy(found.status, to.status);
  copy(found.nx, to.nx), copy(found.ny, to.ny), copy(found.nz, to.nz);
}

}  // namespace
}  // namespace scarp::c

using namespace scarp::c;

scarp_status scarp_cast_camera(const scarp_scene* scene, const scarp_camera* camera, const scarp_fan_answers* answers) {
  return guarded_on_threads([&] {
    const scarp::Terrain& terrain = only_terrain(scene);
    const scarp_camera given = read(camera, "camera");
    scarp::PinholeCamera own{.eye = vector_from(given.eye, "eye"),
                             .forward = vector_from(given.forward, "forward"),
                             .columns = given.columns,
                             .rows = given.rows,
                             .tan_half_width = given.tan_half_width,
                             .t_min = given.t_min,
                             .t_max = end_of(given.t_max)};
    if (const scarp::dvec3 up = vector_from(given.up, "up"); up != scarp::dvec3(0.0)) own.up = up;
    cast_into(answers_from(answers), own.columns, own.rows,
              [&](scarp::FanAnswers& found) { scarp::cast_from(terrain, own, found); });
  });
}

scarp_status scarp_cast_scanner(const scarp_scene* scene, const scarp_scanner* scanner,
                                const scarp_fan_answers* answers) {
  return guarded_on_threads([&] {
    const scarp::Terrain& terrain = only_terrain(scene);
    const scarp_scanner given = read(scanner, "scanner");
    if (given.columns < 0 || given.rows < 0)
      throw scarp::Error(fmt::format("scanner: {} x {} rays", given.columns, given.rows));
    const auto rows = static_cast<std::size_t>(given.rows);
    const double* first = required(given.elevations, rows, "scanner: elevations");
    const scarp::Scanner own{.eye = vector_from(given.eye, "eye"),
                             .elevations = {first, first + rows},
                             .columns = given.columns,
                             .first_azimuth = given.first_azimuth,
                             .azimuth_step = given.azimuth_step,
                             .t_min = given.t_min,
                             .t_max = end_of(given.t_max)};
    cast_into(answers_from(answers), given.columns, given.rows,
              [&](scarp::FanAnswers& found) { scarp::cast_from(terrain, own, found); });
  });
}

scarp_status scarp_cast_fan(const scarp_scene* scene, const scarp_fan* fan, const scarp_fan_answers* answers) {
  return guarded_on_threads([&] {
    const scarp::Terrain& terrain = only_terrain(scene);
    const scarp_fan given = read(fan, "fan");
    const scarp::Fan own{.origin = vector_from(given.eye, "eye"),
                         .dx = given.dx,
                         .dy = given.dy,
                         .dz = given.dz,
                         .columns = given.columns,
                         .rows = given.rows,
                         .row_stride = given.columns,
                         .t_min = given.t_min,
                         .t_max = end_of(given.t_max)};
    cast_into(answers_from(answers), given.columns, given.rows,
              [&](scarp::FanAnswers& found) { scarp::cast_from(terrain, own, found.hits()); });
  });
}
