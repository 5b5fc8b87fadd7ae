// SPDX-License-Identifier: MIT
// A turning scanner with several channels (a lidar) on a body that stands or moves.
//
//   world ◀── pose of the body at a time ◀── mounting ◀── azimuth of the column, elevation of the channel
//
//   scarp::Lidar lidar{.elevations = elevations, .columns = 1800, .azimuth_step = 2 * pi / 1800, .path = {pose}};
//   const scarp::LidarScan scan(scene, lidar);
//   std::vector<scarp::LidarReturn> returns;
//   scan.cast(0, 100, returns);                // columns 0 to 99: returns[column * channels + channel]
//
// A column is a firing of all channels, one after the other if they have offsets in time. Its azimuth belongs to its
// time: a turn takes 1 / rate seconds, and the scanner is silent in a part of the circle without columns.
//
// Positions between two poses are linear in time, orientations follow the shortest arc at constant speed. Angles are in
// radians. Headings and azimuths count clockwise from `north`, pitch is positive with the nose up, roll with the right
// side down; they are applied in this order. A body looks along its forward axis, up is z at pitch and roll 0.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "scarp/base/ray.h"
#include "scarp/base/vec.h"
#include "scarp/scene/scene.h"
#include "scarp/scene/terrain.h"

namespace scarp {

/// Place and orientation of the scanner on its body.
struct LidarMounting {
  double forward = 0, right = 0, up = 0;  ///< metres from the position of the body
  double yaw = 0, pitch = 0, roll = 0;    ///< yaw clockwise as seen from above
};

/// The body at a time.
struct LidarPose {
  double time = 0;      ///< seconds
  dvec3 position{0.0};  ///< metres, world
  double heading = 0, pitch = 0, roll = 0;
};

struct Lidar {
  std::vector<double> elevations{};       ///< one per channel, in the order of their firing, -pi/2 to pi/2
  std::vector<double> time_offsets{};     ///< seconds after the column's time, 0 or more; one per channel, or empty
  std::vector<double> azimuth_offsets{};  ///< added to the azimuth of the column; one per channel, or empty
  int columns = 0;                        ///< per turn
  double first_azimuth = 0;
  double azimuth_step = 0;  ///< between columns; negative: it turns counterclockwise
  double rate = 10;         ///< turns per second, above 0
  int turns = 1;            ///< with one pose; along a path it scans from the first to the last pose
  double min_range = 0;     ///< metres; nearer surfaces block rays without a return
  double max_range = std::numeric_limits<double>::infinity();
  double range_noise = 0;  ///< standard deviation of the ranges in metres
  std::uint64_t seed = 1;  ///< of the noise
  LidarMounting mounting{};
  std::vector<LidarPose> path{};  ///< one: it stands; several: times rise
  bool above_ground = false;      ///< z of positions counts from the ground below, Scene::height()
  double north = 0;               ///< radians clockwise from the y axis of the world to north

  std::size_t channels() const { return elevations.size(); }
};

/// The answer of a ray. Without a hit, range is infinite and `position` undefined.
struct LidarReturn {
  double time = 0;          ///< seconds
  std::int64_t column = 0;  ///< from 0
  std::int32_t channel = 0;
  HitStatus status = HitStatus::miss;
  std::uint32_t object = 0;
  float azimuth = 0, elevation = 0;  ///< direction in the world: clockwise from north, above the horizon
  /// Angle from straight down to the direction's part across the heading, -pi to pi, positive to the right.
  float scan_angle = 0;
  float range = 0;  ///< metres, with its noise
  dvec3 position{0.0};

  explicit operator bool() const { return status == HitStatus::hit; }
};

/// Throws Error "scanner: ..." for a value out of its range, lists of different lengths, or times that do not rise.
void validate(const Lidar& lidar);

/// How rays are traced; the answers agree within the tolerance of fans in doc/dev/numerics.md.
enum class LidarWay : std::uint8_t {
  automatic,  ///< fans if the scanner stands on a scene of one height field with the march max-mip, on the CPU
  batches,
};

/// The rays of a lidar in a scene. Thread-safe as the scene is.
class LidarScan {
 public:
  /// Refers to the scene. Throws Error as validate() does, for a range without an end in a scene that wraps, for no
  /// ground below a position that counts from it, and for more than 2^40 rays.
  LidarScan(const Scene& scene, Lidar lidar, LidarWay way = LidarWay::automatic);

  const Lidar& lidar() const { return lidar_; }
  /// Number of columns of the whole scan.
  std::int64_t columns() const { return columns_; }
  bool by_fans() const { return terrain_.has_value(); }
  /// Time of a column, without the offset of a channel.
  double time_of(std::int64_t column) const;

  /// Sets returns[i * channels + channel] to the answer of column first + i, on all threads. Results depend on no
  /// thread. Fans start again with each piece: their ranges depend on the pieces, within the tolerance of fans. Throws
  /// Error for columns that do not exist, more than 2^30 at once, and where the ground ends below the path.
  void cast(std::int64_t first, std::int64_t count, std::vector<LidarReturn>& returns) const;

 private:
  struct Station;
  Station station_at(double time) const;
  Station placed(const dvec3& position, const dmat3& body) const;
  dvec3 direction(const Station& station, int column_of_turn, std::size_t channel) const;
  void describe(const Station& station, const dvec3& direction, LidarReturn& answer) const;
  void set_range(const dvec3& eye, const dvec3& direction, double t, LidarReturn& answer) const;
  void cast_fan(std::int64_t first, std::int64_t count, std::vector<LidarReturn>& returns) const;
  void cast_batch(std::int64_t first, std::int64_t count, std::vector<LidarReturn>& returns) const;

  const Scene& scene_;
  Lidar lidar_;
  std::int64_t columns_ = 0;
  bool still_ = true;
  std::vector<std::size_t> by_slope_;      // channels in rising order of elevation
  std::vector<dvec2> turns_, tilts_;       // sine and cosine of the columns' azimuths and of the elevations
  std::vector<dvec2> turn_offsets_;        // of the channels' azimuth offsets
  std::optional<HeightTarget> terrain_{};  // of the scene, for fans
};

}  // namespace scarp
