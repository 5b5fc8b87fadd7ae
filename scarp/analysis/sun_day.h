// SPDX-License-Identifier: MIT
// The sun over one place behind its skyline: when it is seen first and last on a day, how long, and how much energy of
// a clear sky reaches the ground there. Requires a build with ERFA (SCARP_ERFA).
//
// The sun shines if its centre is above the level and not below the horizon in its own azimuth (horizon_from(): every
// crossing, in double). Positions are tested in steps; between a bright and a dark one the moment is found by
// bisection, to half a second. Sun or shade that lasts less than a step may be missed.
//
// Energy is that of sun_hours.h, with the sun in the middle of each step. The ground slopes as the central differences
// of the bilinear heights one cell away; the sky view factor is that of 64 directions.
#pragma once

#include <optional>

#include "scarp/analysis/horizon.h"
#include "scarp/analysis/sun_position.h"

namespace scarp {

struct SunPlaceSettings {
  double col = 0, row = 0;  ///< in cells
  EarthPlace place{};       ///< there
  double grid_north = 0;    ///< azimuth of grid north there, radians
  bool refraction = false;
  HorizonSettings horizon{};
  int step = 1;  ///< minutes, 1 to 1440
  // For energy only.
  bool energy = false;
  double linke = 3, albedo = 0.2;         ///< as ClearSkyGround
  std::optional<double> transmittance{};  ///< as ClearSkyGround
};

struct SunDay {
  std::optional<double> first, last;  ///< hours since midnight; nullopt: no sun
  double hours = 0;
  double beam = 0, diffuse = 0, reflected = 0;  ///< kWh per square metre of ground; 0 without energy
};

class SunPlace {
 public:
  /// Refers to the samples of the field. Throws Error as horizon_from() does, for a place outside the field or over a
  /// hole, and for settings out of range.
  SunPlace(const HeightField& field, const SunPlaceSettings& settings);

  /// The sun, `hours` after midnight.
  SunPosition sun(const UtcTime& midnight, double hours) const;
  /// Whether the sun shines from a position.
  bool is_lit(const SunPosition& sun) const;
  /// `midnight`: beginning of the day. `day_of_year`: 1 to 366.
  SunDay day(const UtcTime& midnight, double day_of_year) const;

 private:
  HeightField field_;
  SunPlaceSettings settings_;
  double height_ = 0;                        // of the ground
  double east_ = 0, north_ = 0, level_ = 1;  // its normal, from grid north
  double sky_view_factor_ = 1;
};

}  // namespace scarp
