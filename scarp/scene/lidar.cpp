// SPDX-License-Identifier: MIT
#include "scarp/scene/lidar.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <numeric>
#include <utility>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/scene/cast_from.h"

namespace scarp {
namespace {

constexpr double kPi = std::numbers::pi, kTurn = 2 * kPi;
constexpr std::int64_t kMostRays = std::int64_t{1} << 40;
constexpr std::int64_t kMostColumnsPerCall = std::int64_t{1} << 30;  // fans count them in 32 bits
constexpr std::int64_t kLidarGrain = 4096;

bool all_finite(const dvec3& v) { return std::isfinite(v.x + v.y + v.z); }

dvec2 sine_cosine(double angle) { return {std::sin(angle), std::cos(angle)}; }

// Axes right, forward and up.
glm::dquat orientation(double heading, double pitch, double roll) {
  return glm::angleAxis(-heading, dvec3(0, 0, 1)) * glm::angleAxis(pitch, dvec3(1, 0, 0)) *
         glm::angleAxis(roll, dvec3(0, 1, 0));
}

// Two steps of "splitmix64" (G. Steele et al., "Fast splittable pseudorandom number generators", 2014) of a seed and a
// counter: a number does not depend on those before it.
std::uint64_t mixed(std::uint64_t seed, std::uint64_t counter) {
  const auto mix = [](std::uint64_t x) {
    x += 0x9e3779b97f4a7c15;
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9;
    x = (x ^ x >> 27) * 0x94d049bb133111eb;
    return x ^ x >> 31;
  };
  return mix(mix(seed) + counter);
}

// A number of the standard normal distribution (Box and Muller, 1958).
double normal_number(std::uint64_t seed, std::uint64_t ray) {
  const auto share = [&](std::uint64_t counter) {  // above 0, at most 1
    return static_cast<double>((mixed(seed, counter) >> 11) + 1) * 0x1p-53;
  };
  return std::sqrt(-2 * std::log(share(2 * ray))) * std::cos(kTurn * share(2 * ray + 1));
}

double latest_offset(const Lidar& lidar) {
  return lidar.time_offsets.empty() ? 0 : *std::max_element(lidar.time_offsets.begin(), lidar.time_offsets.end());
}

}  // namespace

void validate(const Lidar& lidar) {
  const auto require = [](bool good, const char* what) {
    if (!good) throw Error(fmt::format("scanner: {}", what));
  };
  require(!lidar.elevations.empty(), "has no elevations");
  for (const double elevation : lidar.elevations)
    require(std::abs(elevation) <= kPi / 2, "elevations must be -90 to 90 degrees");
  for (const auto* offsets : {&lidar.time_offsets, &lidar.azimuth_offsets}) {
    require(offsets->empty() || offsets->size() == lidar.channels(), "offsets must be one per elevation");
    for (const double offset : *offsets) require(std::isfinite(offset), "offsets must be finite");
  }
  for (const double offset : lidar.time_offsets) require(offset >= 0, "offsets in time must be 0 or more");
  require(lidar.columns > 0, "has no columns");
  require(std::isfinite(lidar.first_azimuth) && std::isfinite(lidar.azimuth_step), "azimuths must be finite");
  // A step that was divided out of a whole turn may exceed it by its rounding.
  require(std::abs(lidar.azimuth_step) * lidar.columns <= kTurn * (1 + 0x1p-40), "columns exceed a whole turn");
  require(std::isfinite(lidar.rate) && lidar.rate > 0, "the rate must be above 0 turns per second");
  require(lidar.turns > 0, "must make one turn at least");
  require(lidar.min_range >= 0 && lidar.max_range > lidar.min_range, "the range must rise, from 0 metres or more");
  require(std::isfinite(lidar.range_noise) && lidar.range_noise >= 0, "the noise must be 0 metres or more");
  const LidarMounting& mounting = lidar.mounting;
  require(all_finite({mounting.forward, mounting.right, mounting.up}) &&
              all_finite({mounting.yaw, mounting.pitch, mounting.roll}),
          "its mounting must be finite");
  require(std::isfinite(lidar.north), "north must be finite");
  require(!lidar.path.empty(), "has no pose");
  for (std::size_t i = 0; i < lidar.path.size(); ++i) {
    const LidarPose& pose = lidar.path[i];
    if (!all_finite(pose.position) || !all_finite({pose.heading, pose.pitch, pose.roll}) || !std::isfinite(pose.time))
      throw Error(fmt::format("scanner: pose {} is not finite", i));
    if (i > 0 && !(pose.time > lidar.path[i - 1].time))
      throw Error(fmt::format("scanner: the time of pose {} is not later than that of the pose before it", i));
  }
}

// The scanner at a time.
struct LidarScan::Station {
  dvec3 eye;
  glm::dmat3 axes;  // of the scanner: right, forward, up
  dvec2 right;      // of the body's heading, horizontal unit vector; zero if it looks straight up or down
};

LidarScan::LidarScan(const Scene& scene, Lidar lidar, LidarWay way) : scene_(scene), lidar_(std::move(lidar)) {
  validate(lidar_);
  if (scene.wraps() && std::isinf(lidar_.max_range))
    throw Error("scanner: has no largest range, which terrain that wraps round requires");
  still_ = lidar_.path.size() == 1;
  if (lidar_.above_ground) {
    for (std::size_t i = 0; i < lidar_.path.size(); ++i) {
      const dvec3& at = lidar_.path[i].position;
      if (!scene.height(at.x, at.y)) throw Error(fmt::format("scanner: no ground below pose {}", i));
    }
  }
  const auto channels = static_cast<std::int64_t>(lidar_.channels());
  const LidarPose &first = lidar_.path.front(), &last = lidar_.path.back();
  const double duration = last.time - first.time;
  const double most =
      still_ ? static_cast<double>(lidar_.turns) * lidar_.columns : (duration * lidar_.rate + 1) * lidar_.columns;
  if (!(most * static_cast<double>(channels) <= static_cast<double>(kMostRays)))
    throw Error(fmt::format("scanner: makes {:.3g} rays, more than 2^40 (reduce its rate, turns or path)",
                            most * static_cast<double>(channels)));
  if (still_) {
    columns_ = std::int64_t{lidar_.turns} * lidar_.columns;
  } else {
    // The columns all of whose channels fire until the last pose.
    std::int64_t low = 0, high = static_cast<std::int64_t>(most) + 1;
    while (low < high) {
      const std::int64_t middle = low + (high - low) / 2;
      if (time_of(middle) + latest_offset(lidar_) <= last.time) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    columns_ = low;
  }
  by_slope_.resize(lidar_.channels());
  std::iota(by_slope_.begin(), by_slope_.end(), std::size_t{0});
  std::stable_sort(by_slope_.begin(), by_slope_.end(),
                   [&](std::size_t a, std::size_t b) { return lidar_.elevations[a] < lidar_.elevations[b]; });
  for (int i = 0; i < lidar_.columns; ++i)
    turns_.push_back(sine_cosine(lidar_.first_azimuth + i * lidar_.azimuth_step));
  for (const double elevation : lidar_.elevations) tilts_.push_back(sine_cosine(elevation));
  for (const double offset : lidar_.azimuth_offsets) turn_offsets_.push_back(sine_cosine(offset));
  if (way == LidarWay::automatic && still_) terrain_ = scene.fan_target();
}

double LidarScan::time_of(std::int64_t column) const {
  const std::int64_t turn = column / lidar_.columns, i = column % lidar_.columns;
  const double turns = static_cast<double>(turn) + static_cast<double>(i) * (std::abs(lidar_.azimuth_step) / kTurn);
  return lidar_.path.front().time + turns / lidar_.rate;
}

LidarScan::Station LidarScan::placed(const dvec3& position, const glm::dmat3& body) const {
  const LidarMounting& m = lidar_.mounting;
  Station station;
  station.eye = position;
  if (lidar_.above_ground) {
    const auto ground = scene_.height(position.x, position.y);
    if (!ground) throw Error("scanner: no ground below its path");
    station.eye.z += *ground;
  }
  station.eye += body * dvec3(m.right, m.forward, m.up);
  station.axes = body * glm::mat3_cast(orientation(m.yaw, m.pitch, m.roll));
  const dvec2 across(body[1].y, -body[1].x);  // the forward axis, turned to the right
  const double size = std::hypot(across.x, across.y);
  station.right = size > 0 ? across / size : dvec2(0.0);
  return station;
}

LidarScan::Station LidarScan::station_at(double time) const {
  const std::vector<LidarPose>& path = lidar_.path;
  const auto turned = [&](const LidarPose& pose) {
    return orientation(pose.heading + lidar_.north, pose.pitch, pose.roll);
  };
  if (still_) return placed(path.front().position, glm::mat3_cast(turned(path.front())));
  const auto later = std::upper_bound(path.begin() + 1, path.end() - 1, time,
                                      [](double t, const LidarPose& pose) { return t < pose.time; });
  const LidarPose &a = *(later - 1), &b = *later;
  const double share = std::clamp((time - a.time) / (b.time - a.time), 0.0, 1.0);
  const glm::dquat body = glm::normalize(glm::slerp(turned(a), turned(b), share));
  try {
    return placed(a.position + share * (b.position - a.position), glm::mat3_cast(body));
  } catch (const Error& error) {
    throw Error(fmt::format("{} at {:.6g} s", error.what(), time));
  }
}

// Rounded to floats: fans trace such directions, and others must not differ from them.
dvec3 LidarScan::direction(const Station& station, int column_of_turn, std::size_t channel) const {
  dvec2 turn = turns_[static_cast<std::size_t>(column_of_turn)];
  const dvec2 tilt = tilts_[channel];
  if (!turn_offsets_.empty()) {
    const dvec2 more = turn_offsets_[channel];
    turn = {turn.x * more.y + turn.y * more.x, turn.y * more.y - turn.x * more.x};
  }
  const dvec3 d = station.axes * dvec3(turn.x * tilt.y, turn.y * tilt.y, tilt.x);
  return dvec3(vec3(d));
}

void LidarScan::describe(const Station& station, const dvec3& d, LidarReturn& answer) const {
  double azimuth = std::fmod(std::atan2(d.x, d.y) - lidar_.north, kTurn);
  if (azimuth < 0) azimuth += kTurn;
  answer.azimuth = static_cast<float>(azimuth);
  if (answer.azimuth >= static_cast<float>(kTurn)) answer.azimuth = 0;  // rounded up to it
  answer.elevation = static_cast<float>(std::atan2(d.z, std::hypot(d.x, d.y)));
  answer.scan_angle = static_cast<float>(std::atan2(d.x * station.right.x + d.y * station.right.y, -d.z));
  answer.status = HitStatus::miss;
  answer.object = 0;
  answer.range = std::numeric_limits<float>::infinity();
}

void LidarScan::set_range(const dvec3& eye, const dvec3& d, double t, LidarReturn& answer) const {
  const double size = length(d);
  double range = t * size;
  if (range < lidar_.min_range) return;
  if (lidar_.range_noise > 0) {
    const auto ray =
        static_cast<std::uint64_t>(answer.column) * lidar_.channels() + static_cast<std::uint64_t>(answer.channel);
    range = std::max(0.0, range + lidar_.range_noise * normal_number(lidar_.seed, ray));
  }
  answer.status = HitStatus::hit;
  answer.range = static_cast<float>(range);
  answer.position = eye + range / size * d;
}

void LidarScan::cast(std::int64_t first, std::int64_t count, std::vector<LidarReturn>& returns) const {
  if (first < 0 || count < 0 || first > columns_ - count)
    throw Error(fmt::format("scanner: {} columns from {} on, of {}", count, first, columns_));
  if (count > kMostColumnsPerCall) throw Error(fmt::format("scanner: {} columns at once (cast fewer)", count));
  returns.resize(static_cast<std::size_t>(count) * lidar_.channels());
  if (terrain_) {
    cast_fan(first, count, returns);
  } else {
    cast_batch(first, count, returns);
  }
}

void LidarScan::cast_fan(std::int64_t first, std::int64_t count, std::vector<LidarReturn>& returns) const {
  const std::size_t channels = lidar_.channels();
  const auto strip_size = static_cast<std::size_t>(kFanStrip) * channels;
  const std::int64_t strips = (count + kFanStrip - 1) / kFanStrip;
  const std::size_t size = static_cast<std::size_t>(strips) * strip_size;
  const Station station = station_at(lidar_.path.front().time);
  std::vector<float> dx(size), dy(size), dz(size), t(size), u(size), v(size);
  std::vector<std::int32_t> col(size), row(size);
  std::vector<HitStatus> status(size);
  const auto place = [&](std::int64_t i, std::size_t r) {
    return static_cast<std::size_t>(i / kFanStrip) * strip_size + r * kFanStrip +
           static_cast<std::size_t>(i % kFanStrip);
  };
  const std::int64_t grain = std::max<std::int64_t>(1, kLidarGrain / static_cast<std::int64_t>(channels));
  parallel_for(count, grain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) {
      const std::int64_t column = first + i;
      const double time = time_of(column);
      for (std::size_t r = 0; r < channels; ++r) {
        const std::size_t channel = by_slope_[r], at = place(i, r);
        const dvec3 d = direction(station, static_cast<int>(column % lidar_.columns), channel);
        dx[at] = static_cast<float>(d.x), dy[at] = static_cast<float>(d.y), dz[at] = static_cast<float>(d.z);
        LidarReturn& answer = returns[static_cast<std::size_t>(i) * channels + channel];
        answer.time = time + (lidar_.time_offsets.empty() ? 0 : lidar_.time_offsets[channel]);
        answer.column = column, answer.channel = static_cast<std::int32_t>(channel);
        describe(station, d, answer);
      }
    }
  });
  Fan fan;
  fan.origin = station.eye;
  fan.dx = dx.data(), fan.dy = dy.data(), fan.dz = dz.data();
  fan.columns = static_cast<int>(count), fan.rows = static_cast<int>(channels);
  fan.row_stride = kFanStrip, fan.strip_stride = static_cast<std::ptrdiff_t>(strip_size);
  // Directions have length 1, but for their rounding; a longer ray may hit beyond the range.
  fan.t_max = lidar_.max_range;
  cast_from(*terrain_, fan, {t.data(), col.data(), row.data(), u.data(), v.data(), status.data()});
  parallel_for(count, grain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) {
      for (std::size_t r = 0; r < channels; ++r) {
        const std::size_t at = place(i, r);
        LidarReturn& answer = returns[static_cast<std::size_t>(i) * channels + by_slope_[r]];
        if (status[at] == HitStatus::hit) {
          set_range(station.eye, {dx[at], dy[at], dz[at]}, static_cast<double>(t[at]), answer);
        } else {
          answer.status = status[at];
        }
      }
    }
  });
}

void LidarScan::cast_batch(std::int64_t first, std::int64_t count, std::vector<LidarReturn>& returns) const {
  const std::size_t channels = lidar_.channels();
  std::vector<Ray> rays(returns.size());
  std::vector<Hit> hits(returns.size());
  const std::int64_t grain = std::max<std::int64_t>(1, kLidarGrain / static_cast<std::int64_t>(channels));
  parallel_for(count, grain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) {
      const std::int64_t column = first + i;
      const double time = time_of(column);
      Station station = station_at(time);
      for (std::size_t channel = 0; channel < channels; ++channel) {
        const std::size_t at = static_cast<std::size_t>(i) * channels + channel;
        LidarReturn& answer = returns[at];
        answer.time = time + (lidar_.time_offsets.empty() ? 0 : lidar_.time_offsets[channel]);
        answer.column = column, answer.channel = static_cast<std::int32_t>(channel);
        if (!still_ && !lidar_.time_offsets.empty()) station = station_at(answer.time);
        const dvec3 d = direction(station, static_cast<int>(column % lidar_.columns), channel);
        describe(station, d, answer);
        rays[at].origin = station.eye, rays[at].direction = d;
        rays[at].t_max = lidar_.max_range;
      }
    }
  });
  scene_.closest_hits(rays, hits);
  parallel_for(static_cast<std::int64_t>(rays.size()), kLidarGrain, [&](std::int64_t begin, std::int64_t end) {
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
      if (hits[i]) {
        returns[i].object = hits[i].object;
        set_range(rays[i].origin, rays[i].direction, hits[i].t, returns[i]);
      } else {
        returns[i].status = hits[i].status;
      }
    }
  });
}

}  // namespace scarp
