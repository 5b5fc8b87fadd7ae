// SPDX-License-Identifier: MIT
#include "bench/rays.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "bench/fields.h"
#include "bench/random.h"
#include "scarp/accel/max_pyramid.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/base/two_floats.h"
#include "scarp/march/height/max_mip.h"

namespace scarp::bench {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::int64_t kRaysPerPiece = 4096;
constexpr int kTile = 8;

// Each class has its own random sequence, so omitting one does not change the others.
std::uint64_t class_seed(std::uint64_t seed, RayClass ray_class) {
  return seed * 16 + static_cast<std::uint64_t>(ray_class);
}

BenchRay make_ray(dvec3 origin, dvec3 direction, float t_max = kInfinity) {
  return {static_cast<float>(origin.x),
          static_cast<float>(origin.y),
          static_cast<float>(origin.z),
          static_cast<float>(direction.x),
          static_cast<float>(direction.y),
          static_cast<float>(direction.z),
          t_max};
}

// Compass azimuth and altitude as a direction.
dvec3 direction_to(double azimuth, double altitude) {
  return {std::sin(azimuth) * std::cos(altitude), std::cos(azimuth) * std::cos(altitude), std::sin(altitude)};
}

// The origin of a ray from the surface near (x, y), in float32 numbers, kLift above both surfaces.
dvec3 lifted(const HeightField& field, double x, double y) {
  // Rounding to float may leave the field slightly.
  const double fx = std::min(as_float(x), field.width());
  const double fy = std::min(as_float(y), field.depth());
  const double z = std::max(field.height(fx, fy).value(), triangle_height(field, fx, fy).value()) + kLift;
  float fz = static_cast<float>(z);
  if (fz < z) fz = std::nextafter(fz, kInfinity);
  return {fx, fy, fz};
}

std::vector<BenchRay> primary_rays(const PinholeCamera& camera) {
  std::vector<BenchRay> rays(static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height));
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto [x, y] = primary_pixel(i, camera.width);
    const double sx = ((x + 0.5) / camera.width * 2 - 1) * camera.half_width,
                 sy = (1 - (y + 0.5) / camera.height * 2) * camera.half_height;
    rays[i] = make_ray(camera.eye, normalize(camera.forward + sx * camera.right + sy * camera.up));
  }
  return rays;
}

// One ray for each primary ray that hits, in their order.
template <class MakeRay>
std::vector<BenchRay> rays_from_hits(const HeightField& field, const std::vector<BenchRay>& primary,
                                     const MakeRay& make) {
  const MaxPyramid pyramid(field);
  const HeightTarget target{&field, &pyramid};
  std::vector<BenchRay> rays(primary.size());
  std::vector<char> hits(primary.size());
  parallel_for(static_cast<std::int64_t>(primary.size()), kRaysPerPiece, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) {
      const BenchRay& from = primary[static_cast<std::size_t>(i)];
      Ray ray;
      ray.origin = {from.ox, from.oy, from.oz};
      ray.direction = {from.dx, from.dy, from.dz};
      const Hit hit = march_max_mip(target, ray);
      if (!hit) continue;
      hits[static_cast<std::size_t>(i)] = 1;
      const dvec3 at = field.world_from_grid(hit.cell.col + hit.u, hit.cell.row + hit.v, 0);
      rays[static_cast<std::size_t>(i)] = make(i, lifted(field, at.x, at.y), hit);
    }
  });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (hits[i]) rays[kept++] = rays[i];
  }
  rays.resize(kept);
  return rays;
}

// Cosine-distributed about a unit normal.
dvec3 cosine_direction(Random& random, dvec3 normal) {
  const double radius = std::sqrt(random.uniform()), angle = random.uniform(0, 2 * kPi);
  const dvec3 side = normalize(cross(normal, std::abs(normal.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
  return radius * std::cos(angle) * side + radius * std::sin(angle) * cross(normal, side) +
         std::sqrt(std::max(0.0, 1 - radius * radius)) * normal;
}

std::vector<BenchRay> grazing_rays(const HeightField& field, std::int64_t count, std::uint64_t seed) {
  std::vector<BenchRay> rays;
  for (std::int64_t i = 0; i < count; ++i) {
    Random random(seed, static_cast<std::uint64_t>(i));
    const double x = random.uniform(0, field.width()), y = random.uniform(0, field.depth());
    rays.push_back(make_ray(lifted(field, x, y), direction_to(random.uniform(0, 2 * kPi), 3 * kPi / 180)));
  }
  return rays;
}

std::vector<BenchRay> chunk_rays(const HeightField& field, int side, dvec3 sun) {
  std::vector<BenchRay> rays;
  rays.reserve(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
  for (int tile_y = 0; tile_y < side; tile_y += kTile) {
    for (int tile_x = 0; tile_x < side; tile_x += kTile) {
      for (int y = tile_y; y < tile_y + kTile; ++y) {
        for (int x = tile_x; x < tile_x + kTile; ++x) {
          rays.push_back(
              make_ray(lifted(field, (x + 0.5) / side * field.width(), (y + 0.5) / side * field.depth()), sun));
        }
      }
    }
  }
  return rays;
}

// Rays aimed at positions where parts of the surface meet. In plan the coordinates are multiples of 2^-10, so the ray
// is exactly over its target at t = 1 (over square cells); its height there is that of the surface to half a float32
// step of the origin's height.
std::vector<BenchRay> node_rays(const HeightField& field, std::int64_t count, std::uint64_t seed) {
  constexpr double kGrid = 0x1p-10;
  std::vector<BenchRay> rays;
  for (std::int64_t i = 0; i < count; ++i) {
    Random random(seed, static_cast<std::uint64_t>(i));
    for (;;) {
      const int col = random.below(field.cell_cols()), row = random.below(field.cell_rows());
      const double along = (1 + random.below(1022)) * kGrid;
      double u = 0, v = 0;
      switch (i % 4) {
        case 0:
          break;  // a node
        case 1:
          u = along;
          break;  // an edge from column to column
        case 2:
          v = along;
          break;  // an edge from row to row
        default:
          u = 1 - along, v = along;
          break;  // the diagonal that the triangles share
      }
      const dvec3 plan = field.world_from_grid(col + u, row + v, 0);
      const dvec3 target(plan.x, plan.y, field.height(plan.x, plan.y).value());
      const double above = 600, lean = std::min(0.4 * above, 0.25 * std::min(field.width(), field.depth()));
      const auto snap = [&](double value) { return std::round(value / kGrid) * kGrid; };
      const dvec3 origin(target.x + snap(random.uniform(-lean, lean)), target.y + snap(random.uniform(-lean, lean)),
                         static_cast<float>(std::max(target.z + above, field.max_height() + 1)));
      const dvec3 direction = target - origin;
      // Continues to below the lowest sample. Only a ray that is over the field along its whole length must hit.
      const float t_max = static_cast<float>((origin.z - field.min_height() + 1) / -direction.z);
      const dvec3 end = origin + direction * static_cast<double>(t_max);
      const auto over_field = [&](dvec3 p) { return p.x > 0 && p.x < field.width() && p.y > 0 && p.y < field.depth(); };
      if (!over_field(origin) || !over_field(end)) continue;
      rays.push_back(make_ray(origin, direction, t_max));
      break;
    }
  }
  return rays;
}

// Above both surfaces, inside the field, below the point at which the camera looks.
constexpr double kScannerHeight = 2, kNearHeight = 3;  // cells
constexpr double kNearPitch = -5 * kPi / 180;
constexpr double kLowestElevation = -25 * kPi / 180, kHighestElevation = 15 * kPi / 180;

dvec3 stand(const HeightField& field, const RayView& view, double height) {
  dvec3 at = lifted(field, view.target.x * field.width(), view.target.y * field.depth());
  if (height > 0) at.z = as_float(at.z - kLift + height);
  return at;
}

std::vector<BenchRay> lidar_rays(dvec3 scanner, int rows, int columns) {
  std::vector<BenchRay> rays;
  rays.reserve(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns));
  for (int row = 0; row < rows; ++row) {
    const double elevation = kHighestElevation + (row + 0.5) / rows * (kLowestElevation - kHighestElevation);
    for (int column = 0; column < columns; ++column) {
      const double azimuth = (column + 0.5) / columns * 2 * kPi;
      rays.push_back(make_ray(scanner, direction_to(azimuth, elevation)));
    }
  }
  return rays;
}

// Looks north-east.
PinholeCamera near_camera(const HeightField& field, const RayCounts& counts, const RayView& view) {
  PinholeCamera camera = primary_camera(field, counts.width, counts.height, view);
  camera.eye = stand(field, view, kNearHeight);
  camera.forward = direction_to(kPi / 4, kNearPitch);
  camera.right = normalize(cross(camera.forward, dvec3(0, 0, 1)));
  camera.up = cross(camera.right, camera.forward);
  return camera;
}

// cell(i) returns the column and row of ray i.
template <class CellOf>
RayFan fan_of(const std::vector<BenchRay>& rays, int columns, int rows, const CellOf& cell) {
  RayFan fan;
  if (columns % 16 != 0) return fan;
  fan.origin = {rays[0].ox, rays[0].oy, rays[0].oz};
  fan.columns = columns, fan.rows = rows;
  fan.place.resize(rays.size());
  for (std::vector<float>* numbers : {&fan.dx, &fan.dy, &fan.dz}) numbers->resize(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto [column, row] = cell(i);
    const std::size_t at =
        (static_cast<std::size_t>(column) / 16 * static_cast<std::size_t>(rows) + static_cast<std::size_t>(row)) * 16 +
        static_cast<std::size_t>(column) % 16;
    fan.place[i] = static_cast<std::uint32_t>(at);
    fan.dx[at] = rays[i].dx, fan.dy[at] = rays[i].dy, fan.dz[at] = rays[i].dz;
  }
  return fan;
}
RayFan camera_fan(const std::vector<BenchRay>& rays, const RayCounts& counts) {
  return fan_of(rays, counts.width, counts.height, [&](std::size_t i) { return primary_pixel(i, counts.width); });
}
RayFan scanner_fan(const std::vector<BenchRay>& rays, int rows, int columns) {
  return fan_of(rays, columns, rows, [&](std::size_t i) {
    const auto at = static_cast<int>(i);
    return PrimaryPixel{at % columns, at / columns};
  });
}

std::vector<Ray> library_rays_of(const std::vector<BenchRay>& rays) {
  std::vector<Ray> to(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const BenchRay& from = rays[i];
    to[i].origin = {from.ox, from.oy, from.oz};
    to[i].direction = {from.dx, from.dy, from.dz};
    to[i].t_max = from.t_max;
  }
  return to;
}

std::vector<RayPacket> packets_of(const std::vector<BenchRay>& rays) {
  constexpr std::size_t kLanes = RayPacket::kLanes;
  std::vector<RayPacket> packets((rays.size() + kLanes - 1) / kLanes);
  for (std::size_t i = 0; i < packets.size() * kLanes; ++i) {
    RayPacket& packet = packets[i / kLanes];
    const std::size_t lane = i % kLanes;
    const BenchRay& ray = rays[std::min(i, rays.size() - 1)];
    packet.ox[lane] = ray.ox, packet.oy[lane] = ray.oy, packet.oz[lane] = ray.oz;
    packet.dx[lane] = ray.dx, packet.dy[lane] = ray.dy, packet.dz[lane] = ray.dz;
    packet.t_max[lane] = ray.t_max;
    packet.valid[lane] = i < rays.size() ? -1 : 0;
  }
  return packets;
}

}  // namespace

std::vector<RayRecord> records_of(const std::vector<BenchRay>& rays) {
  std::vector<RayRecord> to;
  to.reserve(rays.size());
  for (const BenchRay& ray : rays)
    to.push_back({ray.ox, ray.oy, ray.oz, 0, ray.dx, ray.dy, ray.dz, 0, ray.t_max, ~0u, 0, 0});
  return to;
}

std::string_view name_of(RayClass ray_class) {
  switch (ray_class) {
    case RayClass::primary:
      return "primary";
    case RayClass::shadow:
      return "shadow";
    case RayClass::grazing:
      return "grazing";
    case RayClass::ao:
      return "ao";
    case RayClass::nodes:
      return "nodes";
    case RayClass::chunk:
      return "chunk";
    case RayClass::lidar:
      return "lidar";
    case RayClass::lidar_ground:
      return "lidar-ground";
    case RayClass::near:
      return "near";
    case RayClass::lidar64:
      break;
  }
  return "lidar64";
}

RayClass find_ray_class(std::string_view name) {
  for (const RayClass ray_class : kRayClasses) {
    if (name_of(ray_class) == name) return ray_class;
  }
  throw Error(
      fmt::format("ray class '{}': unknown (available: primary, shadow, grazing, ao, nodes, chunk, lidar, "
                  "lidar-ground, near, lidar64)",
                  name));
}

PinholeCamera primary_camera(const HeightField& field, int width, int height, const RayView& view) {
  const double extent = std::max(field.width(), field.depth());
  const dvec3 eye(view.eye.x * field.width(), view.eye.y * field.depth(), field.max_height() + view.eye.z * extent);
  const dvec3 target(view.target.x * field.width(), view.target.y * field.depth(),
                     field.min_height() + view.target.z * (field.max_height() - field.min_height()));
  const dvec3 forward = normalize(target - eye), right = normalize(cross(forward, dvec3(0, 0, 1)));
  const double half_height = std::tan(45.0 / 2 * kPi / 180);
  return {width,
          height,
          dvec3(as_float(eye.x), as_float(eye.y), as_float(eye.z)),
          right,
          cross(right, forward),
          forward,
          half_height * width / height,
          half_height};
}

// Sizes are multiples of the tiles' side.
PrimaryPixel primary_pixel(std::size_t ray, int width) {
  const int tile = static_cast<int>(ray / (kTile * kTile)), in_tile = static_cast<int>(ray % (kTile * kTile));
  const int across = width / kTile;
  return {tile % across * kTile + in_tile % kTile, tile / across * kTile + in_tile / kTile};
}

std::vector<RaySet> make_rays(const BenchField& ground, const std::vector<RayClass>& classes, const RayCounts& counts,
                              std::uint64_t seed, const RayView& view) {
  const HeightField& field = ground.field;
  const std::vector<BenchRay> primary = primary_rays(primary_camera(field, counts.width, counts.height, view));
  const dvec3 sun = direction_to(view.sun_azimuth_deg * kPi / 180, view.sun_altitude_deg * kPi / 180);
  std::vector<RaySet> sets;
  for (const RayClass ray_class : kRayClasses) {
    if (std::find(classes.begin(), classes.end(), ray_class) == classes.end()) continue;
    RaySet set{ray_class, false, false, {}};
    const std::uint64_t own_seed = class_seed(seed, ray_class);
    switch (ray_class) {
      case RayClass::primary:
        set.rays = primary;
        set.fan = camera_fan(set.rays, counts);
        break;
      case RayClass::shadow:
        set.any_hit = true;
        set.rays =
            rays_from_hits(field, primary, [&](std::int64_t, dvec3 from, const Hit&) { return make_ray(from, sun); });
        break;
      case RayClass::grazing:
        set.any_hit = true;
        set.rays = grazing_rays(field, counts.grazing, own_seed);
        break;
      case RayClass::ao:
        set.any_hit = true;
        set.rays = rays_from_hits(field, primary, [&](std::int64_t i, dvec3 from, const Hit& hit) {
          Random random(own_seed, static_cast<std::uint64_t>(i));
          return make_ray(from, cosine_direction(random, field.normal(hit.cell, hit.u, hit.v)));
        });
        break;
      case RayClass::nodes:
        set.must_hit = true;
        set.rays = node_rays(field, counts.nodes, own_seed);
        break;
      case RayClass::chunk:
        set.any_hit = true;
        set.rays = chunk_rays(field, counts.chunk, sun);
        break;
      case RayClass::lidar:
      case RayClass::lidar_ground:
        set.rays = lidar_rays(stand(field, view, ray_class == RayClass::lidar ? kScannerHeight : 0), counts.lidar_rows,
                              counts.lidar_columns);
        set.fan = scanner_fan(set.rays, counts.lidar_rows, counts.lidar_columns);
        break;
      case RayClass::near:
        set.rays = primary_rays(near_camera(field, counts, view));
        set.fan = camera_fan(set.rays, counts);
        break;
      case RayClass::lidar64:
        set.rays = lidar_rays(stand(field, view, kScannerHeight), counts.lidar64_rows, counts.lidar_columns);
        set.fan = scanner_fan(set.rays, counts.lidar64_rows, counts.lidar_columns);
        break;
    }
    if (set.rays.empty()) {
      throw Error(fmt::format("ray class '{}': no primary ray hits {}; it needs at least one", name_of(ray_class),
                              ground.name));
    }
    set.packets = packets_of(set.rays);
    set.records = records_of(set.rays);
    set.library_rays = library_rays_of(set.rays);
    sets.push_back(std::move(set));
  }
  return sets;
}

}  // namespace scarp::bench
