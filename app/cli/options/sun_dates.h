// SPDX-License-Identifier: MIT
// Dates and UTC offsets of options, and as text.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "scarp/analysis/sun_position.h"

namespace scarp::cli {

inline constexpr int kMinutesPerDay = 24 * 60;

/// Days from the first to the last.
struct DayRange {
  std::chrono::sys_days from, to;
};
/// Parses --date, "2026-06-21", and --to, which may be empty. Throws Error naming the option.
DayRange days_of(const std::string& date, const std::string& to);
/// Parses --utc-offset: minutes east of UTC; nullopt: not typed. Throws Error.
std::optional<int> offset_of(const std::string& text);
/// Returns the offset in whole hours, as minutes, for which noon is within half an hour of the sun's highest position.
int offset_by_longitude(double longitude);

/// "+05:30".
std::string offset_text(int minutes);
/// "2026-06-21".
std::string date_text(std::chrono::sys_days day);
/// "2026-06-21", or "2026-06-21 to 2026-06-22".
std::string dates_text(std::chrono::sys_days from, std::chrono::sys_days to);

/// 1 to 366.
double day_of_year(std::chrono::sys_days day);
/// The beginning of a day in local time.
UtcTime midnight_of(std::chrono::sys_days day, int offset);

}  // namespace scarp::cli
