// SPDX-License-Identifier: MIT
// The sun's position in the sky. Requires a build with ERFA (SCARP_ERFA).
//
// The centre of the sun's disc as seen from the ground: ERFA's Earth ephemeris (epv00), precession and nutation
// IAU 2006/2000A, aberration, parallax and the Earth's rotation. Error below 0.001 degree from 1900 to 2100 without
// refraction, except for UT1 - UTC, which is taken as 0: at most 0.9 s, 0.004 degree.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace scarp {

/// A time in UTC as a Julian date in two parts, ERFA's quasi-JD.
struct UtcTime {
  double day = 0, fraction = 0;
};

/// Parses "2026-06-21T09:00+02:00": ISO 8601 with date, time and offset (Z, +HH, +HH:MM); seconds optional, with
/// fractions. Throws Error for any other form, a date that does not exist, or a year outside 1900..2100.
UtcTime parse_time(const std::string& text);

/// Returns the minutes east of Greenwich of a UTC offset: Z, +HH, +HHMM or +HH:MM, at most 14 hours; nullopt for any
/// other text.
std::optional<int> parse_utc_offset(std::string_view text);

/// A position on Earth, WGS 84.
struct EarthPlace {
  double longitude = 0, latitude = 0;  ///< radians, east and north positive
  double height = 0;                   ///< metres
};

struct SunPosition {
  double azimuth = 0;   ///< radians clockwise from true north, 0..2pi
  double altitude = 0;  ///< radians above the horizon; negative at night
};

/// The sun at one time, for many places: computes everything independent of the place once.
class SunAtTime {
 public:
  /// Throws Error for a time outside ERFA's range.
  explicit SunAtTime(const UtcTime& time);

  /// As sun_position().
  SunPosition at(const EarthPlace& place, bool refraction = false) const;

 private:
  UtcTime terrestrial_;
  double earth_[2][3], from_sun_[3];   // Earth: barycentric position and velocity, and position relative to the sun
  double pole_x_, pole_y_, origin_s_;  // celestial pole and origin
  double rotation_, origin_sp_;        // rotation of the Earth, and the terrestrial origin
};

/// `refraction`: applies that of a standard atmosphere at this height and 10 degrees Celsius (Saemundsson 1986), which
/// lifts the sun by 0.5 degree at the horizon. Below about 1 degree of altitude refraction is uncertain by more than
/// 0.01 degree.
SunPosition sun_position(const UtcTime& time, const EarthPlace& place, bool refraction = false);

}  // namespace scarp
