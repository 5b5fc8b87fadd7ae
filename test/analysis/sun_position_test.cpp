// SPDX-License-Identifier: MIT
#include "scarp/analysis/sun_position.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "scarp/base/error.h"

namespace scarp {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kTolerance = 0.01;  // degrees

// I. Reda, A. Andreas, "Solar Position Algorithm for Solar Radiation Applications", NREL/TP-560-34302, table A5.1:
// zenith 50.11162, azimuth 194.34024 degrees, with refraction.
TEST(SunPosition, MatchesThePublishedNrelExample) {
  const EarthPlace place{-105.1786 * kDegree, 39.742476 * kDegree, 1830.14};
  const SunPosition sun = sun_position(parse_time("2003-10-17T12:30:30-07:00"), place, true);
  EXPECT_NEAR(sun.altitude / kDegree, 90 - 50.11162, kTolerance);
  EXPECT_NEAR(sun.azimuth / kDegree, 194.34024, kTolerance);
  EXPECT_LT(sun_position(parse_time("2003-10-17T12:30:30-07:00"), place).altitude, sun.altitude);
}

// J. Meeus, "Astronomical Algorithms", example 25.b: 1992 October 13, 0h TD (59 s before in UT): declination
// -7.783817 degrees. At the pole the altitude is the declination, except for parallax (0.0024 degree).
TEST(SunPosition, AltitudeAtThePoleIsTheDeclination) {
  const SunPosition sun = sun_position(parse_time("1992-10-12T23:59:01Z"), {0, 90 * kDegree, 0});
  EXPECT_NEAR(sun.altitude / kDegree, -7.783817 - 0.0024, 0.001);
}

// Refraction by apparent altitude: G. G. Bennett, "The Calculation of Astronomical Refraction in Marine Navigation",
// Journal of Navigation 35, 1982, for 10 degrees Celsius and 1010 mbar: 34.5 minutes of arc on the horizon.
TEST(SunPosition, RefractionIsThatOfBennett) {
  const EarthPlace place{0, 45 * kDegree, 0};
  const double day = parse_time("2026-03-20T00:00Z").day;
  for (const double altitude : {0.0, 1.0, 2.0, 5.0, 10.0, 20.0}) {
    // The evening of an equinox: the sun sinks from 26 degrees.
    double high = 15.5 / 24, low = 19.0 / 24;
    for (int i = 0; i < 40; ++i) {
      const double middle = (high + low) / 2;
      (sun_position({day, middle}, place, true).altitude > altitude * kDegree ? high : low) = middle;
    }
    const double lifted = sun_position({day, high}, place, true).altitude - sun_position({day, high}, place).altitude;
    const double minutes = 1 / std::tan((altitude + 7.31 / (altitude + 4.4)) * kDegree);
    // Both formulas agree within 0.1 minutes (J. Meeus, "Astronomical Algorithms", chapter 16); the pressure differs.
    EXPECT_NEAR(lifted / kDegree * 60, minutes * 1013.25 / 1010, 0.1) << altitude;
  }
}

// March equinox of 2026: 20 March 14:46 UTC. The sun is over the equator.
TEST(SunPosition, IsOnTheEquatorAtEquinox) {
  EXPECT_NEAR(sun_position(parse_time("2026-03-20T14:46Z"), {0, 90 * kDegree, 0}).altitude / kDegree, 0, kTolerance);
}

TEST(SunPosition, AppliesTimeZoneOffsets) {
  const UtcTime z = parse_time("2026-06-21T07:00Z"), east = parse_time("2026-06-21T09:00:00.0+02:00"),
                west = parse_time("2026-06-21 02:30-0430");
  constexpr double kRounding = 0x1p-50;  // a few roundings of a fraction of a day
  EXPECT_NEAR(z.fraction, east.fraction, kRounding);
  EXPECT_NEAR(z.fraction, west.fraction, kRounding);
}

TEST(SunPosition, RejectsOtherTimeFormats) {
  for (const char* text :
       {"", "2026-06-21", "2026-06-21T09:00", "2026-02-30T09:00Z", "2026-06-21T25:00Z", "21.6.2026",
        "2026-06-21T09:00+2", "2026- 6-21T09:00Z", "2026-06-21T 9:00Z", " 026-06-21T09:00Z", "2026-+6-21T09:00Z",
        "2026-06-21T09:00+ 4: 5", "2026-06-21T09:00: 5Z", "2026-06-21T09:00+0200Z", "2026-06-21T09:00+02:00x",
        "1492-06-21T09:00Z", "2026-06-21T09:00:99Z"})
    EXPECT_THROW(parse_time(text), Error) << text;
}

TEST(SunPosition, ParsesUtcOffsets) {
  for (const auto& [text, minutes] :
       {std::pair("Z", 0), {"+01:00", 60}, {"-04:30", -270}, {"-0430", -270}, {"+14", 840}})
    EXPECT_EQ(parse_utc_offset(text), minutes) << text;
  for (const char* text : {"", "5", "+5", "+15:00", "+05:60", "+ 4: 5", "+-4:05", "+4:05", "+04:05 ", "04:05"})
    EXPECT_EQ(parse_utc_offset(text), std::nullopt) << text;
}

}  // namespace
}  // namespace scarp
