// SPDX-License-Identifier: MIT
// The rays of the benchmarks. Origins and directions are float32 numbers, so that an engine in double and one in float
// trace bit-identical rays.
//
//   primary   a pinhole camera over the southern border; pixels in tiles of 8 x 8
//   shadow    from the primary hits to a sun 20 degrees high; in their order
//   ao        from the primary hits, cosine-distributed about the surface normal; in their order
//   grazing   from random points of the surface, 3 degrees above the horizon, any azimuth
//   nodes     from far above at nodes, points of edges and points of diagonals, ending below the ground: each must hit
//   lidar     a scanner 2 cells above the ground: rows of equal elevation over all azimuths
//   lidar-ground  the same scanner on the ground
//   near      the pixels of `primary` from a camera 3 cells above the ground that looks along it
//   lidar64   the scanner of lidar with 64 rows, as on cars
//   chunk     from points spread evenly over the field to the same sun, as for a shadow map of it; in tiles of 8 x 8
//
// Rays from the surface start slightly above both the bilinear surface and the two triangles (kLift), so that no engine
// benefits from special rules for rays that start on its surface.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "bench/fields.h"
#include "scarp/base/ray.h"

namespace scarp::bench {

/// Height above the higher of the two surfaces at which rays from the surface start, in cells.
constexpr double kLift = 0.01;

enum class RayClass { primary, shadow, grazing, ao, nodes, chunk, lidar, lidar_ground, near, lidar64 };
constexpr RayClass kRayClasses[] = {RayClass::primary, RayClass::shadow, RayClass::grazing, RayClass::ao,
                                    RayClass::nodes,   RayClass::chunk,  RayClass::lidar,   RayClass::lidar_ground,
                                    RayClass::near,    RayClass::lidar64};
std::string_view name_of(RayClass ray_class);
/// Throws Error listing the classes if the name is unknown.
RayClass find_ray_class(std::string_view name);

/// A ray with t in [0, t_max].
struct BenchRay {
  float ox, oy, oz;
  float dx, dy, dz;
  float t_max;
};

/// Sixteen rays side by side, the layout of packet engines, which may take four or eight at a time; the last packet of
/// a set may have invalid ones (valid 0, else -1).
struct alignas(64) RayPacket {
  static constexpr int kLanes = 16;
  float ox[kLanes], oy[kLanes], oz[kLanes];
  float dx[kLanes], dy[kLanes], dz[kLanes];
  float t_max[kLanes];
  int valid[kLanes];
};

/// A ray as Embree lays it out (RTCRay).
struct alignas(16) RayRecord {
  float ox, oy, oz, t_near;
  float dx, dy, dz, time;
  float t_max;
  std::uint32_t mask, id, flags;
};

/// The same rays, from t = 0, with all bits of the mask.
std::vector<RayRecord> records_of(const std::vector<BenchRay>& rays);

/// The rays of a camera or a scanner in the layout of fans: strips of 16 columns, row by row in each.
struct RayFan {
  dvec3 origin{0.0};
  int columns = 0, rows = 0;  ///< columns: a multiple of 16; 0: the set is not a fan
  std::vector<float> dx{}, dy{}, dz{};
  std::vector<std::uint32_t> place{};  ///< index in the fan of each ray of the set

  bool empty() const { return columns == 0; }
};

struct RaySet {
  RayClass ray_class;
  bool any_hit;   ///< whether the query is any-hit or closest-hit
  bool must_hit;  ///< whether every ray hits
  std::vector<BenchRay> rays;
  std::vector<RayPacket> packets{};  ///< the same rays in the layout of packet engines
  std::vector<RayRecord> records{};  ///< the same rays one after the other, in Embree's layout
  std::vector<Ray> library_rays{};   ///< the same rays in the library's layout
  RayFan fan{};                      ///< the same rays, if they form a fan

  std::int64_t size() const { return static_cast<std::int64_t>(rays.size()); }
};

struct RayCounts {
  int width = 1920;  ///< pixels of the camera, multiples of 8
  int height = 1080;
  std::int64_t grazing = 1 << 20;
  std::int64_t nodes = 1 << 20;
  int chunk = 1024;  ///< points per side, a multiple of 8
  int lidar_rows = 512, lidar_columns = 2048, lidar64_rows = 64;
};

/// The camera of the primary rays and the sun of the shadow rays.
struct RayView {
  std::string_view name = "over the south";
  dvec3 eye{0.5, 0.02,
            0.05};  ///< fractions of width and depth; height above the highest point as a fraction of the longer side
  dvec3 target{0.5, 0.5, 0.5};   ///< fractions of width, depth and relief
  double sun_azimuth_deg = 315;  ///< compass
  double sun_altitude_deg = 20;
};

/// The camera of the primary rays; half_width and half_height are tangents of half the angles of view.
struct PinholeCamera {
  int width, height;
  dvec3 eye;  ///< float32 numbers
  dvec3 right, up, forward;
  double half_width, half_height;
};
PinholeCamera primary_camera(const HeightField& field, int width, int height, const RayView& view = {});
struct PrimaryPixel {
  int x, y;
};
/// The pixel of a primary ray, from its number.
PrimaryPixel primary_pixel(std::size_t ray, int width);

/// The requested classes, in the order of kRayClasses. Deterministic by seed.
std::vector<RaySet> make_rays(const BenchField& ground, const std::vector<RayClass>& classes, const RayCounts& counts,
                              std::uint64_t seed, const RayView& view = {});

}  // namespace scarp::bench
