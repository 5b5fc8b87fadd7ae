// SPDX-License-Identifier: MIT
#include "scarp/analysis/sun_position.h"

#include <erfa.h>
#include <erfam.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>

#include "scarp/base/error.h"

namespace scarp {
namespace {

constexpr int kFirstYear = 1900, kLastYear = 2100;

[[noreturn]] void refuse(const std::string& text, std::string_view what) {
  throw Error(fmt::format("time '{}': {}", text, what));
}

// Reads N numbers from text in the form of a pattern, whose digits stand for those of the numbers: "00:11" has two.
// Returns nullopt for text in another form.
template <std::size_t N>
std::optional<std::array<int, N>> numbers_in(std::string_view text, std::string_view pattern) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (text.size() != pattern.size()) return std::nullopt;
  std::array<int, N> numbers{};
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (is_digit(pattern[i]) ? !is_digit(text[i]) : text[i] != pattern[i]) return std::nullopt;
    if (!is_digit(pattern[i])) continue;
    int& number = numbers[static_cast<std::size_t>(pattern[i] - '0')];
    number = 10 * number + (text[i] - '0');
  }
  return numbers;
}

}  // namespace

std::optional<int> parse_utc_offset(std::string_view text) {
  if (text == "Z" || text == "z") return 0;
  if (text.empty() || (text.front() != '+' && text.front() != '-')) return std::nullopt;
  const std::string_view digits = text.substr(1);
  std::optional<std::array<int, 2>> numbers;
  for (const std::string_view pattern : {"00", "0011", "00:11"})
    if (!numbers) numbers = numbers_in<2>(digits, pattern);
  if (!numbers || (*numbers)[0] > 14 || (*numbers)[1] > 59) return std::nullopt;
  return (text.front() == '-' ? -1 : 1) * (60 * (*numbers)[0] + (*numbers)[1]);
}

UtcTime parse_time(const std::string& text) {
  constexpr std::size_t kDateAndTime = 16;  // characters
  std::string start = text.substr(0, kDateAndTime);
  if (start.size() > 10 && (start[10] == 't' || start[10] == ' ')) start[10] = 'T';
  const auto numbers = numbers_in<5>(start, "0000-11-22T33:44");
  if (!numbers) refuse(text, "expected YYYY-MM-DDTHH:MM[:SS] and an offset, for example 2026-06-21T09:00+02:00");
  const auto [year, month, day, hour, minute] = *numbers;
  const char* rest = text.c_str() + kDateAndTime;
  double seconds = 0;
  if (*rest == ':') {
    int digits = 0;
    if (std::sscanf(rest, ":%lf%n", &seconds, &digits) != 1 || rest[1] < '0' || rest[1] > '9' || !(seconds < 61))
      refuse(text, "expected seconds from 0 to 60");
    rest += digits;
  }
  const std::optional<int> offset = parse_utc_offset(rest);
  if (!offset) refuse(text, "expected a UTC offset at its end, for example 2026-06-21T09:00+02:00 or ...T07:00Z");
  if (year < kFirstYear || year > kLastYear) refuse(text, fmt::format("year outside {} to {}", kFirstYear, kLastYear));
  UtcTime time;
  if (eraDtf2d("UTC", year, month, day, hour, minute, seconds, &time.day, &time.fraction) < 0)
    refuse(text, "no such date or time");
  constexpr double kMinutesPerDay = 1440;
  time.fraction -= *offset / kMinutesPerDay;
  return time;
}

namespace {

// Radians by which a standard atmosphere lifts the sun at this height in metres: Th. Saemundsson, "Atmospheric
// Refraction", Sky and Telescope 72, 1986, for 10 degrees Celsius. ERFA's model holds down to 3 degrees of altitude.
double refraction_at(double altitude, double height) {
  constexpr double kSeaPressure = 1013.25, kFormulaPressure = 1010, kScaleHeight = 8434.5;
  // The formula grows wildly far below the horizon, where refraction has no effect.
  constexpr double kLowest = -1;
  const double degrees = std::max(altitude * ERFA_DR2D, kLowest);
  const double minutes = 1.02 / std::tan((degrees + 10.3 / (degrees + 5.11)) * ERFA_DD2R);
  const double pressure = kSeaPressure * std::exp(-height / kScaleHeight);
  return std::max(minutes, 0.0) / 60 * ERFA_DD2R * pressure / kFormulaPressure;
}

}  // namespace

SunAtTime::SunAtTime(const UtcTime& time) {
  // The steps of eraApco13() that do not depend on the place. UT1 - UTC: see the header.
  double tai[2], ut1[2];
  if (eraUtctai(time.day, time.fraction, &tai[0], &tai[1]) < 0 ||
      eraTaitt(tai[0], tai[1], &terrestrial_.day, &terrestrial_.fraction) < 0 ||
      eraUtcut1(time.day, time.fraction, 0, &ut1[0], &ut1[1]) < 0)
    throw Error("sun: the time is out of range");
  const double tt[2] = {terrestrial_.day, terrestrial_.fraction};
  double from_sun[2][3], pole[3][3];
  eraEpv00(tt[0], tt[1], from_sun, earth_);
  eraCp(from_sun[0], from_sun_);
  eraPnm06a(tt[0], tt[1], pole);
  eraBpn2xy(pole, &pole_x_, &pole_y_);
  origin_s_ = eraS06(tt[0], tt[1], pole_x_, pole_y_);
  rotation_ = eraEra00(ut1[0], ut1[1]);
  origin_sp_ = eraSp00(tt[0], tt[1]);
}

SunPosition SunAtTime::at(const EarthPlace& place, bool refraction) const {
  // ERFA's arguments are not const.
  double earth[2][3], from_sun[3];
  eraCpv(const_cast<double(*)[3]>(earth_), earth);
  eraCp(const_cast<double*>(from_sun_), from_sun);
  eraASTROM astrom;
  // Polar motion is below 0.0002 degree.
  eraApco(terrestrial_.day, terrestrial_.fraction, earth, from_sun, pole_x_, pole_y_, origin_s_, rotation_,
          place.longitude, place.latitude, place.height, 0, 0, origin_sp_, 0, 0, &astrom);
  // From the observer to the sun; the sun hardly moves while its light is under way.
  double sun[3];
  eraSxp(-1, astrom.eh, sun);
  double proper[3], from_pole[3], longitude = 0, latitude = 0;
  eraAb(sun, astrom.v, astrom.em, astrom.bm1, proper);
  eraRxp(astrom.bpn, proper, from_pole);
  eraC2s(from_pole, &longitude, &latitude);
  double azimuth = 0, zenith = 0, hour_angle = 0, declination = 0, ascension = 0;
  eraAtioq(eraAnp(longitude), latitude, &astrom, &azimuth, &zenith, &hour_angle, &declination, &ascension);
  const double altitude = ERFA_DPI / 2 - zenith;
  return {azimuth, refraction ? altitude + refraction_at(altitude, place.height) : altitude};
}

SunPosition sun_position(const UtcTime& time, const EarthPlace& place, bool refraction) {
  return SunAtTime(time).at(place, refraction);
}

}  // namespace scarp
