// SPDX-License-Identifier: MIT
#include "scarp/scene/cast_from.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/march/usual_ray.h"

namespace scarp {
namespace {

constexpr std::int64_t kFanRaysPerPiece = 8192;

// With the seam of cast(): rays beside a border meet what they meet there.
HeightTarget target_of(const Terrain& terrain) { return terrain.scene().fan_target().value(); }

bool finite(const dvec3& v) { return std::isfinite(v.x + v.y + v.z); }

void require_sound(const HeightTarget& terrain, const dvec3& eye, double t_min, double t_max) {
  const HeightField& field = *terrain.field;
  if (const auto* memory = field.memory(); memory && memory->expired())
    throw Error("terrain: the owner of its samples no longer exists");
  if (terrain.pyramid->edits() != field.edits())
    throw Error("terrain: its field was edited elsewhere (build the terrain again)");
  if (!finite(eye)) throw Error("fan: its eye is not finite");
  if (!std::isfinite(t_min) || !(t_max >= t_min))
    throw Error(fmt::format("fan: its range is {} to {}; t_min must be finite and t_max no less", t_min, t_max));
  if (field.wraps() && std::isinf(t_max))
    throw Error("fan: its range has no end; over a field that wraps round t_max must be finite");
}

// Calls body(begin, end) for pieces of whole strips, on all threads.
template <class Body>
void for_each_strip(int columns, int rows, const Body& body) {
  const std::int64_t strips = (columns + kFanStrip - 1) / kFanStrip;
  const std::int64_t grain =
      std::max<std::int64_t>(1, kFanRaysPerPiece / (std::int64_t{kFanStrip} * std::max(rows, 1)));
  parallel_for(strips, grain, [&](std::int64_t begin, std::int64_t end) {
    body(static_cast<int>(begin) * kFanStrip, std::min(static_cast<int>(end) * kFanStrip, columns));
  });
}

// direction(column, row) makes the rays of one strip after the other.
template <class Direction>
void cast_made(const HeightTarget& terrain, Fan fan, FanAnswers& answers, const Direction& direction) {
  require_sound(terrain, fan.origin, fan.t_min, fan.t_max);
  if (answers.columns != fan.columns || answers.rows != fan.rows)
    throw Error(fmt::format("fan: {} x {} rays, room for {} x {} answers", fan.columns, fan.rows, answers.columns,
                            answers.rows));
  const auto rows = static_cast<std::size_t>(fan.rows);
  for_each_strip(fan.columns, fan.rows, [&](int begin, int end) {
    std::vector<float> dx(rows * kFanStrip), dy(dx.size()), dz(dx.size());
    FanAnswers strip(kFanStrip, fan.rows, !answers.nx.empty());
    Fan part = fan;
    part.dx = dx.data(), part.dy = dy.data(), part.dz = dz.data();
    part.row_stride = kFanStrip;
    for (int first = begin; first < end; first += kFanStrip) {
      const int width = std::min(kFanStrip, end - first);
      for (int row = 0; row < fan.rows; ++row) {
        for (int i = 0; i < width; ++i) {
          const dvec3 d = direction(first + i, row);
          const auto at = static_cast<std::size_t>(row) * kFanStrip + static_cast<std::size_t>(i);
          dx[at] = static_cast<float>(d.x), dy[at] = static_cast<float>(d.y), dz[at] = static_cast<float>(d.z);
        }
      }
      part.columns = width;
      closest_hits_max_mip_fan(terrain, part, strip.hits());
      const auto copy = [&](const auto& from, auto& to) {
        for (int row = 0; row < fan.rows; ++row) {
          std::copy_n(from.begin() + row * kFanStrip, width,
                      to.begin() + static_cast<std::ptrdiff_t>(row) * fan.columns + first);
        }
      };
      copy(strip.t, answers.t), copy(strip.col, answers.col), copy(strip.row, answers.row);
      copy(strip.u, answers.u), copy(strip.v, answers.v), copy(strip.status, answers.status);
      if (answers.nx.empty()) continue;
      copy(strip.nx, answers.nx), copy(strip.ny, answers.ny), copy(strip.nz, answers.nz);
    }
  });
}

// NaN for directions that are zero or not finite. The squares of others may exceed doubles.
dvec3 unit_of(const dvec3& direction) {
  const dvec3 scaled = direction / longest_of(direction);
  return scaled / length(scaled);
}

}  // namespace

FanAnswers::FanAnswers(int width, int height, bool normals) : columns(width), rows(height) {
  if (width < 0 || height < 0) throw Error(fmt::format("fan: {} x {} answers", width, height));
  const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  t.resize(count), col.resize(count), row.resize(count), u.resize(count), v.resize(count), status.resize(count);
  if (normals) nx.resize(count), ny.resize(count), nz.resize(count);
}

FanHits FanAnswers::hits() {
  FanHits to{t.data(), col.data(), row.data(), u.data(), v.data(), status.data()};
  if (!nx.empty()) to.nx = nx.data(), to.ny = ny.data(), to.nz = nz.data();
  return to;
}

void cast_from(const Terrain& terrain, const PinholeCamera& camera, FanAnswers& answers) {
  constexpr double kWidest = 1e6;
  const dvec3 forward = unit_of(camera.forward), side = cross(forward, unit_of(camera.up));
  if (!finite(forward) || !finite(side) || side == dvec3(0.0))
    throw Error("camera: its directions are not finite, or `forward` is zero or along `up`");
  if (!(camera.tan_half_width > 0 && camera.tan_half_width <= kWidest))
    throw Error(
        fmt::format("camera: tan_half_width is {}; it must be above 0 and at most {}", camera.tan_half_width, kWidest));
  const dvec3 right = normalize(side), up = cross(right, forward);
  Fan fan;
  fan.origin = camera.eye;
  fan.columns = camera.columns, fan.rows = camera.rows;
  fan.t_min = camera.t_min, fan.t_max = camera.t_max;
  const double pixel = 2 * camera.tan_half_width / std::max(camera.columns, 1);
  cast_made(target_of(terrain), fan, answers, [&](int column, int row) {
    return forward + pixel * (column + 0.5 - 0.5 * camera.columns) * right +
           pixel * (0.5 * camera.rows - row - 0.5) * up;
  });
}

void cast_from(const Terrain& terrain, const Scanner& scanner, FanAnswers& answers) {
  Fan fan;
  fan.origin = scanner.eye;
  fan.columns = scanner.columns, fan.rows = static_cast<int>(scanner.elevations.size());
  fan.t_min = scanner.t_min, fan.t_max = scanner.t_max;
  const auto is_finite = [](double angle) { return std::isfinite(angle); };
  if (!is_finite(scanner.first_azimuth) || !is_finite(scanner.azimuth_step) ||
      !std::all_of(scanner.elevations.begin(), scanner.elevations.end(), is_finite))
    throw Error("scanner: its angles are not finite");
  std::vector<dvec2> turns, tilts;  // sine and cosine
  for (int column = 0; column < scanner.columns; ++column) {
    const double azimuth = scanner.first_azimuth + column * scanner.azimuth_step;
    turns.emplace_back(std::sin(azimuth), std::cos(azimuth));
  }
  for (const double elevation : scanner.elevations) tilts.emplace_back(std::sin(elevation), std::cos(elevation));
  cast_made(target_of(terrain), fan, answers, [&](int column, int row) {
    const dvec2 turn = turns[static_cast<std::size_t>(column)], tilt = tilts[static_cast<std::size_t>(row)];
    return dvec3(turn.x * tilt.y, turn.y * tilt.y, tilt.x);
  });
}

void cast_from(const Terrain& terrain, const Fan& fan, const FanHits& hits) {
  cast_from(target_of(terrain), fan, hits);
}

void cast_from(const HeightTarget& terrain, const Fan& fan, const FanHits& hits) {
  if (!terrain.field || !terrain.pyramid) throw Error("fan: its terrain has no field or no pyramid");
  require_sound(terrain, fan.origin, fan.t_min, fan.t_max);
  if (fan.columns < 0 || fan.rows < 0) throw Error(fmt::format("fan: {} x {} rays", fan.columns, fan.rows));
  const bool any = fan.columns > 0 && fan.rows > 0;
  if (any && (!fan.dx || !fan.dy || !fan.dz || !hits.t || !hits.col || !hits.row || !hits.u || !hits.v))
    throw Error("fan: an array is missing (only FanHits::status and the normals may be null)");
  if (!hits.nx != !hits.ny || !hits.nx != !hits.nz)
    throw Error("fan: an array of its normals is missing (all or none may be null)");
  for_each_strip(fan.columns, fan.rows,
                 [&](int begin, int end) { closest_hits_max_mip_fan(terrain, fan, hits, begin, end); });
}

}  // namespace scarp
