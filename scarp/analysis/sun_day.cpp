// SPDX-License-Identifier: MIT
#include "scarp/analysis/sun_day.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "scarp/analysis/clear_sky.h"
#include "scarp/analysis/horizon_measures.h"
#include "scarp/analysis/sight.h"
#include "scarp/analysis/tangent_planes.h"
#include "scarp/base/error.h"
#include "scarp/base/setting.h"

namespace scarp {
namespace {

constexpr int kDayMinutes = 24 * 60;
constexpr int kSkyDirections = 64;
constexpr double kMoment = 0.5 / 3600;  // hours

// The sun over a day: cubics through its directions, as vectors, every 20 minutes. Each component is a sinusoid of a
// day, apart from a slow drift: with steps of h = 0.0873 radians, a cubic is off by 3/128 h^4 = 1.4e-6 radians at most,
// which is the sun's way in 0.02 seconds. Refraction near the horizon is not smooth enough.
class SunTrack {
 public:
  SunTrack(const SunPlace& place, const UtcTime& midnight, bool refraction) : place_(place), midnight_(midnight) {
    if (refraction) return;
    for (int i = -1; i <= kKnots + 1; ++i) {
      const SunPosition at = place.sun(midnight, kHours * i);
      knots_.push_back({std::cos(at.altitude) * std::sin(at.azimuth), std::cos(at.altitude) * std::cos(at.azimuth),
                        std::sin(at.altitude)});
    }
  }

  /// `hours`: since midnight, 0 to 24.
  SunPosition at(double hours) const {
    if (knots_.empty()) return place_.sun(midnight_, hours);
    const double i = std::min(std::floor(hours / kHours), kKnots - 1.0), t = hours / kHours - i;
    const dvec3* knot = &knots_[static_cast<std::size_t>(i)];  // the one before
    const dvec3 towards = -t * (t - 1) * (t - 2) / 6 * knot[0] + (t + 1) * (t - 1) * (t - 2) / 2 * knot[1] -
                          (t + 1) * t * (t - 2) / 2 * knot[2] + (t + 1) * t * (t - 1) / 6 * knot[3];
    return {compass_azimuth(towards.x, towards.y), std::atan2(towards.z, std::hypot(towards.x, towards.y))};
  }

 private:
  static constexpr double kHours = 1.0 / 3;
  static constexpr int kKnots = 72;

  const SunPlace& place_;
  const UtcTime midnight_;
  std::vector<dvec3> knots_;
};

}  // namespace

SunPlace::SunPlace(const HeightField& field, const SunPlaceSettings& settings) : field_(field), settings_(settings) {
  require_setting("sun", settings.step >= 1 && settings.step <= kDayMinutes, "step", settings.step, "1 to 1440");
  const SightGround ground(field);
  const auto height = ground.height_at(settings.col, settings.row);
  if (!height) throw Error("the point is over a hole");
  height_ = *height;
  if (!settings.energy) return;
  require_setting("sun energy", settings.linke >= 1 && settings.linke <= 8, "Linke turbidity", settings.linke,
                  "1 to 8");
  const double through = settings.transmittance.value_or(1);
  require_setting("sun energy", through > 0 && through <= 1, "transmittance", through, "above 0, at most 1");
  require_setting("sun energy", settings.albedo >= 0 && settings.albedo <= 1, "albedo", settings.albedo, "0 to 1");
  const dvec3 normal = upward_normal(ground, settings.col, settings.row);
  east_ = normal.x, north_ = normal.y, level_ = normal.z;
  const auto east = static_cast<float>(east_), north = static_cast<float>(north_), level = static_cast<float>(level_);
  float sum = 0;
  for (int i = 0; i < kSkyDirections; ++i) {
    const double azimuth = 2 * std::numbers::pi * i / kSkyDirections;
    const double angle = horizon_from(field, settings.col, settings.row, azimuth, settings.horizon)->angle;
    const auto slope = static_cast<float>(std::tan(angle));
    add_sky_view_factor(&slope, {&east, &north, &level}, static_cast<float>(std::sin(azimuth)),
                        static_cast<float>(std::cos(azimuth)), 1, &sum);
  }
  sky_view_factor_ = static_cast<double>(sum) / kSkyDirections;
}

SunPosition SunPlace::sun(const UtcTime& midnight, double hours) const {
  return sun_position({midnight.day, midnight.fraction + hours / 24}, settings_.place, settings_.refraction);
}

bool SunPlace::is_lit(const SunPosition& sun) const {
  if (!(sun.altitude > 0)) return false;
  const double azimuth = sun.azimuth - settings_.grid_north;
  return sun.altitude >= horizon_from(field_, settings_.col, settings_.row, azimuth, settings_.horizon)->angle;
}

SunDay SunPlace::day(const UtcTime& midnight, double day_of_year) const {
  // The sun climbs by at most 15 degrees per hour; refraction adds a degree at most.
  constexpr double kMostClimb = 15 * std::numbers::pi / 180, kRefraction = std::numbers::pi / 180;
  const SunTrack track(*this, midnight, settings_.refraction);
  double dark_until = 0;  // hours
  const auto is_lit_at = [&](double hours) {
    if (hours < dark_until) return false;
    const SunPosition at = track.at(hours);
    if (at.altitude < -kRefraction) dark_until = hours - (at.altitude + kRefraction) / kMostClimb;
    return is_lit(at);
  };
  // The moment between a bright and a dark one.
  const auto change = [&](double bright, double dark) {
    while (std::abs(bright - dark) > kMoment) {
      const double middle = (bright + dark) / 2;
      (is_lit(track.at(middle)) ? bright : dark) = middle;
    }
    return bright;
  };
  SunDay found;
  bool before = is_lit_at(0);
  for (int minute = 0; minute < kDayMinutes; minute += settings_.step) {
    const double begin = minute / 60.0, end = std::min(minute + settings_.step, kDayMinutes) / 60.0;
    const bool after = is_lit_at(end);
    const double from = before || !after ? begin : change(end, begin);
    const double to = after ? end : before ? change(begin, end) : begin;
    before = after;
    if (to > from) {
      found.hours += to - from;
      if (!found.first) found.first = from;
      found.last = to;
    }
    if (!settings_.energy || end < dark_until) continue;
    const SunPosition middle = track.at((begin + end) / 2);
    const ClearSky sky = clear_sky(middle.altitude, height_, day_of_year, settings_.linke, settings_.transmittance);
    const double azimuth = middle.azimuth - settings_.grid_north, up = std::sin(middle.altitude);
    const double cosine =
        std::cos(middle.altitude) * (std::sin(azimuth) * east_ + std::cos(azimuth) * north_) + up * level_;
    const double hours = (end - begin) / 1000;  // kWh
    found.beam += (to - from) / 1000 * sky.beam * std::max(cosine, 0.0);
    found.diffuse += hours * sky.diffuse * sky_view_factor_;
    found.reflected += hours * settings_.albedo * (sky.beam * std::max(up, 0.0) + sky.diffuse) * (1 - sky_view_factor_);
  }
  return found;
}

}  // namespace scarp
