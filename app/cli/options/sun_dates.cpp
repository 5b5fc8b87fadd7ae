// SPDX-License-Identifier: MIT
#include "app/cli/options/sun_dates.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <string_view>

#include "scarp/base/error.h"

namespace scarp::cli {

namespace chrono = std::chrono;

namespace {

chrono::sys_days day_of(const std::string& text, std::string_view option) {
  constexpr double kEpoch = 2440587.5;  // Julian date of 1970-01-01
  try {
    return chrono::sys_days(chrono::days(std::lround(parse_time(text + "T00:00Z").day - kEpoch)));
  } catch (const Error&) {
    throw Error(fmt::format("{} '{}': expected a date from 1900 to 2100, for example 2026-06-21", option, text));
  }
}

}  // namespace

DayRange days_of(const std::string& date, const std::string& to) {
  const chrono::sys_days first = day_of(date, "--date"), last = to.empty() ? first : day_of(to, "--to");
  if (last < first) throw Error(fmt::format("--to {}: is before --date {}", to, date));
  return {first, last};
}

std::optional<int> offset_of(const std::string& text) {
  if (text.empty()) return std::nullopt;
  const std::optional<int> minutes = parse_utc_offset(text);
  if (!minutes) throw Error(fmt::format("--utc-offset '{}': expected +HH:MM or -HH:MM, for example -04:00", text));
  return minutes;
}

std::string offset_text(int minutes) {
  return fmt::format("{}{:02}:{:02}", minutes < 0 ? '-' : '+', std::abs(minutes) / 60, std::abs(minutes) % 60);
}

std::string date_text(chrono::sys_days day) {
  const chrono::year_month_day date(day);
  return fmt::format("{:04}-{:02}-{:02}", static_cast<int>(date.year()), static_cast<unsigned>(date.month()),
                     static_cast<unsigned>(date.day()));
}

std::string dates_text(chrono::sys_days from, chrono::sys_days to) {
  return from == to ? date_text(from) : date_text(from) + " to " + date_text(to);
}

double day_of_year(chrono::sys_days day) {
  const chrono::sys_days first = chrono::year_month_day(day).year() / chrono::January / 1;
  return static_cast<double>((day - first).count() + 1);
}

UtcTime midnight_of(chrono::sys_days day, int offset) {
  return {parse_time(date_text(day) + "T00:00Z").day, -static_cast<double>(offset) / kMinutesPerDay};
}

int offset_by_longitude(double longitude) { return static_cast<int>(std::lround(longitude / 15)) * 60; }

}  // namespace scarp::cli
